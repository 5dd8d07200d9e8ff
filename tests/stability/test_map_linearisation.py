"""Maps linearised: against finite differences of the map itself, closed forms, and what is refused."""

import control
import numpy as np
import pytest

from flockana import ExplicitEuler, MinimalFlocking, StaticTarget, TaylorStep, ZoneFlocking, find_equilibrium, linearise
from flockana.base.errors import ArgumentError
from flockana.interactions import Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.jond_2025 import ZoneNoise, ZoneWeights
from flockana.sources.vicsek_1995.laws import HeadingAveraging

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
REST = find_equilibrium(LAW, hexagonal_patch(1, 7.0)).q
MAPS = {
    "taylor": TaylorStep(LAW, 0.02),
    "semi-implicit": SemiImplicitEuler(LAW, 0.02),
    "euler": ExplicitEuler(LAW, 0.01),
    "msn": MSNDiscretisation(LAW, 0.02),
    "msn at once": MSNDiscretisation(LAW, 0.02, in_place=False),
}


def differences(law, q, width=1e-6):
    """The map's derivative by central differences, whatever the library knows of it."""

    def step(x):
        after = law.step(0.0, x[: q.size].reshape(q.shape), x[q.size :].reshape(q.shape), {})
        return np.concatenate([after[0].ravel(), after[1].ravel()])

    start, columns = np.concatenate([q.ravel(), np.zeros(q.size)]), []
    for k in range(start.size):
        nudge = np.zeros(start.size)
        nudge[k] = width
        columns.append((step(start + nudge) - step(start - nudge)) / (2.0 * width))
    return np.array(columns).T


@pytest.mark.parametrize("name", MAPS)
def test_a_map_is_linearised_as_it_steps(name):
    flock = linearise(MAPS[name], REST)
    assert np.abs(flock.A - differences(MAPS[name], REST)).max() < 1e-7
    dense = np.linalg.eigvals(flock.A)
    tolerance = 1e-7 if name == "euler" else 1e-12  # critically damped: the dense eigenvalues are double
    assert max(np.abs(dense - z).min() for z in flock.multipliers) < tolerance
    assert np.sum(flock.multipliers == 1.0) == 1  # the rotation, exactly
    assert [mode.name for mode in flock.zero_modes] == ["rotation"]


@pytest.mark.parametrize("name", MAPS)
def test_a_force_held_for_a_step_moves_the_flock_as_the_system_says(name):
    """Of a map in place a force on an agent reaches those after it within the step."""
    flock, law = linearise(MAPS[name], REST), MAPS[name]
    system = flock.state_space
    assert isinstance(system, control.StateSpace)
    assert (system.dt, system.ninputs, system.noutputs) == (law.dt, REST.size, 2 + REST.size)
    if not law.in_place:
        f, h = law.position_factor, law.dt
        assert pytest.approx(np.vstack([f * h * h * np.eye(14), h * np.eye(14)]), abs=1e-18) == flock.B
    else:
        assert np.abs(flock.B[4:14, 0]).max() > 0.0  # agents 2 to 6 answer to agent 0 at once
        assert np.abs(flock.B[0:12, 12]).max() < 1e-15  # none answers to the last
    response = control.forced_response(system, inputs=np.zeros((REST.size, 3)), X0=np.full(2 * REST.size, 0.1))
    assert response.states[:, 2] == pytest.approx(flock.A @ flock.A @ np.full(2 * REST.size, 0.1), abs=1e-12)


def test_one_agent_has_multipliers_in_closed_form():
    """c1γ = 4, c2γ = 3 and h = 0.1: z² − (2 − hd − h²k/2) z + 1 − hd + h²k/2 = 0 under a held input."""
    law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=3.0), target=StaticTarget((0.0,)))
    flock = linearise(TaylorStep(law, 0.1), [[0.0]])
    assert np.sort(flock.multipliers) == pytest.approx(np.sort(np.roots([1.0, -1.68, 0.72])), abs=1e-14)
    held = control.sample_system(control.ss([[0, 1], [0, 0]], [[0], [1]], [[-4, -3]], 0), 0.1, "zoh")
    closed = np.linalg.eigvals(held.A + held.B @ held.C)
    assert np.sort_complex(flock.multipliers) == pytest.approx(np.sort_complex(closed), abs=1e-12)


def test_a_mode_decays_per_step_as_its_multiplier_says():
    flock = linearise(TaylorStep(LAW, 0.02), REST)
    mode = flock.modes[0]
    assert mode.decay_per_step == pytest.approx(1.0 - flock.spectral_radius)
    assert mode.decay_rate == pytest.approx(-np.log(abs(mode.multiplier)) / 0.02)
    assert flock.stable
    assert all(one.decays for one in flock.modes)
    assert not linearise(TaylorStep(LAW, 0.03), REST).stable
    assert len(flock.modes) == len([z for z in flock.multipliers if z.imag >= 0.0 and z != 1.0])


def test_the_minimal_model_on_a_tree_and_the_drift_that_it_leaves():
    law = MinimalFlocking(edges=[(0, 1), (1, 2)], spacing=1.0).discrete(0.1)
    flock = linearise(law, [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    assert np.sum(flock.multipliers == 1.0) == 6  # a motion of the whole, and each edge's direction
    assert flock.spectral_radius == pytest.approx(np.sqrt(1.0 - 0.1), abs=1e-7)  # det = 1 − hd of s² + s + 1
    assert flock.stable


@pytest.mark.parametrize("average", ["headings", "vectors"])
def test_headings_average_their_neighbours(average):
    law = HeadingAveraging(range=1.0, speed=1.0, dt=0.1, average=average)
    q = np.array([[0.0, 0.0], [0.5, 0.0], [1.2, 0.0]])
    flock = linearise(law, q, law.velocities(np.full(3, 0.3)))
    assert pytest.approx(np.array([[1 / 2, 1 / 2, 0], [1 / 3, 1 / 3, 1 / 3], [0, 1 / 2, 1 / 2]])) == flock.A
    assert flock.multipliers == pytest.approx([1.0, 0.5, -1 / 6])
    assert flock.multipliers[0] == 1.0
    assert flock.stable
    turned = law.step(0.0, q, q, {"heading": 0.3 + np.array([1e-6, 0.0, 0.0])})[3]["heading"] - 0.3
    assert turned / 1e-6 == pytest.approx(flock.A[:, 0], abs=1e-6)
    assert flock.state_space.output_labels == ["heading0", "heading1", "heading2"]


SIDE_BY_SIDE = [[0.0, 0.0], [0.0, 15.0 / 5.25]], [[3.0, 0.0], [3.0, 0.0]]  # 5 (3 − d) = ¼ d


@pytest.mark.parametrize("form", ["position", "bearing"])
@pytest.mark.parametrize(("dt", "gain"), [(0.1, 8.0), (0.05, 8.0), (0.1, 1.0)])
def test_zones_are_linearised_where_they_are_smooth(form, dt, gain):
    """Two agents side by side: springs 5 and ¼, alignment ¼ · gain of four, speed 5; v + h u, then q + h v.

    With the paper's dt = 0.1 and a gain of 8 their difference in speed turns over: 1 − 0.1 (5 + 2 · 8) = −1.1.
    """
    law = ZoneFlocking(form=form, dt=dt, weights=ZoneWeights(alignment_gain=gain, cohesion_gain=0.25))
    flock, heed = linearise(law, *SIDE_BY_SIDE), 2.0 * alignment_slope(law)
    across = 1.0 + dt * np.roots([1.0, heed + dt * 10.5, 10.5])
    exact = [1.0, 1.0, 1.0, 1.0, 1.0 - 5.0 * dt, 1.0 - dt * (5.0 + heed), *across]
    for z in exact:
        assert np.abs(flock.multipliers - z).min() < 1e-7
    assert sum(abs(z) > 1e-6 for z in flock.multipliers) == len(exact)  # what is remembered is forgotten at once
    assert sum(flock.multipliers == 1.0) == 4  # two places, one heading with its drift
    assert flock.stable == (max(abs(z) for z in exact[4:]) < 1.0)
    assert flock.stable == ((dt, gain) != (0.1, 8.0))


def alignment_slope(law):
    """How strongly one agent heeds the other's velocity, by the law's own behaviours."""
    q, p = (np.array(x) for x in SIDE_BY_SIDE)
    p[1] += 1e-3, 0.0
    return law.behaviours(q, p)["alignment"][0, 0] / 1e-3


@pytest.mark.parametrize(
    ("law", "q", "p", "message"),
    [
        (ZoneFlocking(), [[0.0, 0.0], [0.0, 20.0]], None, "ZoneFlocking has a kink or a jump at this state"),
        (ZoneFlocking(v_max=3.0), *SIDE_BY_SIDE, "ZoneFlocking has a kink or a jump at this state"),
        (ZoneFlocking(noise=ZoneNoise(weights=0.1)), *SIDE_BY_SIDE, "no steady motion of ZoneFlocking: step changes"),
        (HeadingAveraging(speed=1.0), [[0.0, 0.0], [2.0, 0.0]], [[1.0, 0.0], [0.0, 1.0]], "headings differ by up to 1"),
        (HeadingAveraging(speed=1.0), [[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [1.0, 0.0]], "at the edge of each other"),
        (HeadingAveraging(speed=1.0), [[0.0, 0.0]], None, "agent 0 has the speed 0: expected speed = 1 for all agents"),
        (ZoneFlocking(), [[0.0, 0.0], [2.0, 0.0]], SIDE_BY_SIDE[1], "no steady motion of ZoneFlocking: p changes by"),
        (TaylorStep(Algorithm1(), 0.1), [[0.0, 0.0], [8.0, 0.0]], None, "the state is no equilibrium of Algorithm1"),
    ],
)
def test_what_cannot_be_linearised_is_refused(law, q, p, message):
    with pytest.raises(ArgumentError, match=message):
        linearise(law, q, p)
