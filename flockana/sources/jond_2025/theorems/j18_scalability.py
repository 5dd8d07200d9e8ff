"""The bearing-distance paper's "scalable": flocks of 10 to 500 agents at one density, and what grows with them."""

import numpy as np

from flockana.measures.metrics import coordination, min_distance
from flockana.measures.nets import components, links
from flockana.sources.jond_2025.interactions.zones import ZoneRadii
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import crowd_start
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, mostly, observed, of_map

_LAW = ZoneFlocking(ZoneRadii(1.5, c=3.0, a=5.0))
_SEEDS = {10: 20, 100: 20, 500: 6}  # by number of agents; of 6 none may fail, so that half of all are sure to hold
_SIZES, _DURATION = tuple(_SEEDS), 20.0
_SAFE, _IN_ORDER = 1.5, 0.99  # m; what counts as C = 1
_MORE = 1.25  # times as many neighbours in a flock five times as large are as many
_ROUNDING = 1e-9


def _ends(n: int, *, any_direction: bool = False) -> FloatArray:
    """Return coordination, components, least distance, mean number of neighbours after 20 s, one row per seed."""
    rows = []
    for seed in range(_SEEDS[n]):
        start = crowd_start(seed, n, any_direction=any_direction)
        run = observed(_LAW, *start, (0.0, _DURATION), t_eval=(_DURATION,)).run
        q, p = run.q[-1], run.p[-1]
        edges = links(q, _LAW.radii.reach[2])
        rows.append([coordination(p), components(n, edges).max() + 1, min_distance(q), 2.0 * len(edges) / n])
    return np.array(rows)


def _flocks(n: int, ends: FloatArray) -> Claim:
    return mostly(
        f"flock-{n}",
        (ends[:, 0] >= _IN_ORDER) & (ends[:, 1] == 1) & (ends[:, 2] > _SAFE),
        f"{n} agents are one flock after {_DURATION:g} s, C >= {_IN_ORDER:g}, all more than r apart",
        "flocks of every size align, stay together and keep their distance",
    ).described(witness={"least C": float(ends[:, 0].min()), "least distance": float(ends[:, 2].min())})


@erratum("J18", expected={"verified": "flock-10 flock-100 flock-500 local any-direction"}, ours=("any-direction",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The behaviour is said to be scalable. At the density of section 5.1, 10, 100 and 500 agents order, hold together
    and keep apart, and an agent has as many neighbours whatever the size. The text does not say for which initial
    velocities: its own, in (0, 1), are half aligned already, and from initial velocities of all directions a large
    flock breaks up into many.
    """
    end_states = {n: _ends(n) for n in _SIZES}
    some, many = (float(end_states[n][:, 3].mean()) for n in _SIZES[1:])
    turned = _ends(_SIZES[-1], any_direction=True)
    return [
        *(_flocks(n, end_states[n]) for n in _SIZES),
        of_map("local", _MORE - many / some, _ROUNDING).described(
            computed={n: float(end_states[n][:, 3].mean()) for n in _SIZES},
            stated="an agent interacts with no more agents in a flock five times as large",
            witness={"agents within a_i, mean over seeds": (some, many)},
            detail=f"an agent has {some:.3g} others within a_i among {_SIZES[1]}, and {many:.3g} among {_SIZES[2]}: "
            "the work of an agent does not grow with the flock",
        ),
        mostly(
            "any-direction",
            turned[:, 0] < _IN_ORDER,
            f"{_SIZES[-1]} agents that begin in all directions are not in order after {_DURATION:g} s "
            f"(C = {np.median(turned[:, 0]):.2f} in the median, {np.median(turned[:, 1]):g} components)",
            f"from all directions a large flock is not in order after {_DURATION:g} s",
            witness={"C by seed": turned[:, 0].tolist(), "components by seed": turned[:, 1].astype(int).tolist()},
        ),
    ]
