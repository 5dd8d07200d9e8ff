"""Dead-zone flocking (Li, Yuan, Liu): Theorem 1 as printed and as corrected, errata L1 to L10."""
