"""Reference values with their provenance.

ALPHA: 40-digit adaptive quadrature of φ_α with mpmath, done once by the specification's authors, independent of this
package: (d, r, ε, h, a, b) -> (c, d_α, r_α, ψ_α(0), ψ_α(r_α)).
"""

ALPHA = {
    (7.0, 8.4, 0.1, 0.2, 5.0, 5.0): (
        0.0,
        14.289915602982238,
        18.383093559370867,
        52.383811786644864,
        0.73590113426239231,
    ),
    (1.9, 2.8, 0.1, 0.4, 7.0, 9.0): (
        0.12598815766974241,
        1.6661904664719065,
        3.3566462856512001,
        8.2894763964404246,
        1.9197227378044615,
    ),
    (15.0, 18.0, 0.1, 0.1, 3.0, 3.0): (
        0.0,
        38.47679857416329,
        47.792733107199559,
        77.314354838042652,
        0.80748441845582953,
    ),
}

# For the quadrature of tests/reference/test_quadrature.py: the sources' parameters, then extremes of each.
PARAMETERS = [
    *ALPHA,
    (1.7, 2.5, 0.01, 0.2, 7.0, 15.0),
    (100.0, 120.0, 1e-4, 0.2, 5.0, 5.0),
    (100.0, 500.0, 10.0, 0.01, 5.0, 9.0),
    (100.0, 500.0, 1e-4, 0.99, 5.0, 9.0),  # h r_α > d_α, hundreds of length units of closed form
    (7.0, 7.07, 0.1, 0.01, 5.0, 5.0),  # h r_α < d_α, a thin well
    (7.0, 7.07, 10.0, 0.99, 1.0, 40.0),  # a steep taper
    (0.1, 0.12, 0.1, 0.2, 5.0, 5.0),  # small lengths: ψ is a small difference of large terms
    (0.1, 0.5, 0.1, 0.9, 5.0, 9.0),
    (1e-3, 5e-3, 10.0, 0.5, 1.0, 1000.0),
    (7.0, 8.4, 0.1, 0.7773, 5.0, 5.0),  # h r_α just below d_α
    (0.1, 20.0, 419.0, 0.001, 5.0, 5e4),  # ε = 419, h = 0.001: summed from r_α, c* was off by 7e-12 of itself
    (0.1, 20.0, 419.0, 0.001, 5.0, 5.0),
    (1.0, 200.0, 419.0, 0.001, 5.0, 50.0),
    (1.0, 1.01, 419.0, 0.001, 5.0, 50.0),
    (7.0, 8.4, 419.0, 0.001, 5.0, 5.0),
    (1.0, 900.0, 419.0, 0.0012, 5.0, 5.0),  # h r_α just above d_α, ψ(r_α) some 10⁵ c*
]
