"""Pair laws given by formulas."""

import numpy as np

from flockana import Algorithm1, FormulaInteraction, Scenario, pair_law

BUMP = "Piecewise((1, z < h*r_z), ((1 + cos(pi*(z/r_z - h)/(1 - h)))/2, True))"
SIGMOID = "((a + b)*((z - d_z)/l**2 + c)/sqrt(1 + ((z - d_z)/l**2 + c)**2) + (a - b))/2"


def alpha_formula() -> FormulaInteraction:
    """Olfati-Saber's pair law with the paper's numbers."""
    return pair_law(
        force=f"{BUMP}*{SIGMOID}",
        adjacency=BUMP,
        range=8.4,
        length=7.0,
        parameters={"eps": 0.1, "h": 0.2, "a": 5.0, "b": 5.0, "c": 0.0, "l": 1.0},
        units={"h": (0, 0), "a": (0, 0), "b": (0, 0), "c": (0, 0), "l": (1, 0)},
    )


def spring() -> FormulaInteraction:
    """A double well that ends smoothly: it repels below 2 and attracts above, up to 3."""
    return pair_law(
        "k*(s**2 - d**2)**2*(r**2 - s**2)**2",
        adjacency="(1 - s/r)**2",
        range=3.0,
        length=2.0,
        parameters={"k": 0.01},
        units={"k": (-6, -2)},
    )


def breakable(**changed: float) -> FormulaInteraction:
    """A smooth law, until a parameter breaks it: the same compiled code for many laws.

    b lets the force jump at the range; c takes a peak out of the adjacency, at o and of width 1/w; with e = 0 nothing
    repels.
    """
    numbers = {"k": 0.01, "e": 2.0, "b": 0.0, "c": 0.0, "o": 110.5 * 3.0 / 256.0, "w": 1000.0} | changed
    potential = "k*(s**2 - e**2)**2*(r**2 - s**2)**2 + b*(s**2 - e**2)**2"
    adjacency = "(1 - s/r)**2*(1 - c*exp(-((s - o)*w)**2))"
    return pair_law(potential, adjacency=adjacency, range=3.0, length=2.0, parameters=numbers)


def formula_flock(seed: int) -> Scenario:
    """Four agents under `spring`, at random."""
    rng = np.random.default_rng(seed)
    q = np.array([[0.0, 0.0], [2.2, 0.0], [0.0, 2.2], [2.2, 2.2]]) + rng.normal(0.0, 0.05, (4, 2))
    return Scenario(
        "formula-flock", "A formula", "ours", Algorithm1(spring()), q, 0.0 * q, (0.0, 1.0), seed, {"energy": "verified"}
    )
