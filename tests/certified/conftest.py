"""Basins that several tests read, each certified once."""

import copy
from functools import cache, reduce
from operator import getitem

import numpy as np
import pytest
from flint import arb, ctx

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, certify, find_equilibrium, lattice
from flockana.base.integrity_seals import with_digest

TETRAHEDRON = 7.0 / np.sqrt(8.0) * np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
STARTS = {"pair": lattice.hexagonal_spiral(2, 7.0), "triangle": lattice.hexagonal_spiral(3, 7.0)}
STARTS |= {"hexagon": lattice.hexagonal_patch(1, 7.0), "tetrahedron": TETRAHEDRON}
ALONE = Gains(c1_gamma=1.25, c2_gamma=1.0)  # of one agent and its target: the roots are −½ ± i
NAMES = ("pair", "triangle", "hexagon", "tetrahedron")


@cache
def basin_of(name: str, algorithm: int):
    q = STARTS[name]
    law = Algorithm1() if algorithm == 1 else Algorithm2(target=StaticTarget((0.0,) * q.shape[1]))
    return certify(find_equilibrium(law, q))


@pytest.fixture
def basin(request):
    return basin_of(*request.param)


ALL = pytest.mark.parametrize(
    "basin", [(name, k) for name in NAMES for k in (1, 2)], indirect=True, ids=lambda x: f"{x[0]}-{x[1]}"
)


def displaced(basin, share: float, rng) -> np.ndarray:
    """A shape at a share of ρ from the equilibrium, orthogonal to the orbit, in a random direction."""
    from flockana.equilibria.final_state import rigid_motions

    motions = rigid_motions(basin.rest)
    w = rng.standard_normal(basin.rest.size)
    w -= motions @ (motions.T @ w)
    return share * float(basin.radius) * (w / np.linalg.norm(w)).reshape(basin.rest.shape)


def text_of(law, positions=((0.0,), (7.0,)), box="0.01", **changes):
    """What the certificate of a basin says of a law, and of positions."""
    names = {name: getattr(law.alpha, name) for name in ("d", "r", "eps", "h", "a", "b")}
    names |= {name: getattr(law.gains, name) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
    said = {"algorithm": "Algorithm2"} | {name: str(value) for name, value in (names | changes).items()}
    return {"law": said, "positions": [[float(x).hex() for x in row] for row in positions], "box": box}


def oscillator(t):
    """e^{−t/2}(cos t + ½ sin t) and its derivative, the solution from 1 at rest."""
    with ctx.workprec(200):
        t = arb(t)
        fade = (-t / 2).exp()
        return fade * (t.cos() + t.sin() / 2), -fade * t.sin() * arb(1.25)


def with_leaf(data, at, change):
    """A copy of a certificate in which what stands at a path of keys is changed."""
    altered = copy.deepcopy(data)
    place = leaf(altered, at[:-1])
    place[at[-1]] = change(place[at[-1]])
    return altered


def leaf(data, at):
    """What stands at a path of keys."""
    return reduce(getitem, at, data)


def resealed(data):
    """A certificate with a digest that fits."""
    return with_digest({key: value for key, value in data.items() if key != "digest"})


def more(value):
    """A decimal one thousandth larger."""
    return repr(float(value) * 1.001 + 0.001)
