"""Rigour of the executable proofs that claims name, and what they cite; a test holds both against the proofs."""

from flockana.theorems.theorem import Rigour

RIGOUR: dict[str, Rigour] = {
    "any-potential": "smt",
    "any-potential-limits": "smt",
    "barrier": "interval",
    "bearing-distance": "smt",
    "bearing-distance-printed": "smt",
    "certified-basins": "symbolic",
    "cohesion": "smt",
    "collisions": "smt",
    "compressed-patches": "interval",
    "constant-acceleration": "symbolic",
    "convergence": "smt",
    "cucker-smale": "smt",
    "dead-zone": "smt",
    "delayed-consensus": "interval",
    "deviation-energy": "symbolic",
    "distinct-pairs": "interval",
    "disturbed-basins": "symbolic",
    "double-agent": "interval",
    "energy-identities": "symbolic",
    "headings": "smt",
    "informed-agents": "smt",
    "links-kept": "smt",
    "matched-velocities": "smt",
    "n-max": "interval",
    "net-measures": "smt",
    "nonplanar-fcc": "symbolic",
    "second-order-modes": "smt",
    "smoothness": "symbolic",
    "speed-bound": "interval",
    "stand-off": "symbolic",
    "strained-thirteen": "interval",
    "tanner": "smt",
    "theorem5-counts": "smt",
    "theorem5-crossings": "smt",
    "theorem6": "smt",
    "tracking-gain": "interval",
    "turned-axes": "symbolic",
}

CITES: dict[str, tuple[str, ...]] = {
    "any-potential-limits": ("Barbalat", "LaSalle"),
    "convergence": ("Łojasiewicz", "centre-stable manifold"),
    "matched-velocities": ("Barbalat",),
}
