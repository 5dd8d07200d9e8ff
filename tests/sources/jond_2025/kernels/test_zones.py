"""Zone-based flocking's compiled step against a transcription of the paper's Algorithm 1 in plain loops."""

from math import isclose, tanh

import numpy as np
import pytest

from flockana import Alien, Box, SimplePolygon, ZoneNoise, ZoneRadii, ZoneWeights, ZoneWorld, simulate
from flockana.sources.jond_2025.kernels import zone_counts
from flockana.sources.jond_2025.kernels.neighbour_candidates import sort_into_cells
from flockana.sources.jond_2025.kernels.zone_counts import fragments, populations
from flockana.sources.jond_2025.kernels.zones import saturation
from flockana.sources.jond_2025.laws.zone_flocking import BEHAVIOURS, ZoneFlocking
from tests.kernels.test_random_noise import uniform

R, C, A, S = 1.5, 3.0, 5.0, 6.0
RADII = ZoneRadii(R, c=C, a=A, s=S)


def weights_of(n, aliens, rng):
    tables = {name: rng.uniform(0.2, 2.0, (n, n)) for name in ("separation", "cohesion", "alignment")}
    agents = {name: rng.uniform(0.5, 2.0, n) for name in ("speed", "obstacle")}
    return ZoneWeights(
        **{name: tuple(map(tuple, table.tolist())) for name, table in tables.items()},
        **{name: tuple(values.tolist()) for name, values in agents.items()},
        alien=tuple(map(tuple, rng.uniform(0.5, 2.0, (n, aliens)).tolist())),
        cohesion_gain=0.7,
        alignment_gain=1.3,
    )


def transcription(q, v, aliens, w, *, printed):
    """(3) to (7) as written, agent by agent; the sets by their definitions."""
    n, m = q.shape
    found = {name: np.zeros((n, m)) for name in BEHAVIOURS}
    for i in range(n):
        d = [float(np.sqrt(sum((q[j] - q[i]) ** 2))) for j in range(n)]
        repels = [j for j in range(n) if j != i and 0.0 < d[j] <= C]
        attracts = [j for j in range(n) if j != i and R < d[j] <= A]
        for j in repels:
            found["separation"][i] += w.separation[i][j] * (d[j] - C) * (q[j] - q[i]) / d[j]
        if attracts:
            whole = sum(w.cohesion[i][j] for j in attracts)
            mean = sum(w.cohesion[i][j] * q[j] for j in attracts) / whole
            found["cohesion"][i] = w.cohesion_gain * (mean - q[i])
            whole = sum(w.alignment[i][j] for j in attracts)
            mean = sum(w.alignment[i][j] * v[j] for j in attracts) / whole
            found["alignment"][i] = w.alignment_gain * (mean - v[i])
        for k, x in enumerate(aliens):
            apart = float(np.linalg.norm(x - q[i]))
            if (A if printed else 0.0) < apart <= S:
                found["strategic"][i] += w.alien[i][k] * (apart - S) * (x - q[i]) / apart
        speed = float(np.linalg.norm(v[i]))
        found["speed"][i] = w.speed[i] * (3.0 * v[i] / speed - v[i])
    return found


def a_state(m, seed, n=9, side=7.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, side, (n, m)), rng.normal(size=(n, m)), rng.uniform(0.0, side, (2, m)), rng


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("form", ["position", "bearing"])
@pytest.mark.parametrize("surveillance", ["disc", "annulus"])
def test_behaviours_are_those_of_the_paper(m, form, surveillance):
    q, v, aliens, rng = a_state(m, 10 * m)
    w = weights_of(len(q), 2, rng)
    law = ZoneFlocking(
        RADII, w, ZoneWorld(aliens=tuple(Alien(x) for x in aliens)), form=form, surveillance=surveillance
    )
    wanted = transcription(q, v, aliens, w, printed=surveillance == "annulus")
    found = law.behaviours(q, v)
    for name in BEHAVIOURS:  # cancellation of positions of size 7 in the mean: some units of 7 · 2^-52
        np.testing.assert_allclose(found[name], wanted[name], rtol=1e-12, atol=2e-14, err_msg=name)
    assert min(np.abs(found[name]).max() for name in BEHAVIOURS if name != "obstacle") > 0.1


@pytest.mark.parametrize(
    ("distance", "separates", "attracts"),
    [
        (R, True, False),
        (np.nextafter(R, 9.0), True, True),
        (C, False, True),  # in the set, but d − c = 0
        (np.nextafter(C, 0.0), True, True),
        (np.nextafter(C, 9.0), False, True),
        (A, False, True),
        (np.nextafter(A, 9.0), False, False),
        (0.0, False, False),  # no bearing
    ],
)
@pytest.mark.parametrize("form", ["position", "bearing"])
def test_zones_are_closed_where_the_paper_closes_them(distance, separates, attracts, form):
    parts = ZoneFlocking(RADII, form=form).behaviours([[0.0, 0.0], [distance, 0.0]], [[0.0, 0.0], [0.0, 1.0]])
    assert bool(parts["separation"].any()) is separates
    assert bool(parts["cohesion"].any()) is attracts
    assert bool(parts["alignment"].any()) is attracts


@pytest.mark.parametrize(
    ("distance", "disc", "annulus"), [(4.0, 10.0, 0.0), (A, 5.0, 0.0), (5.5, 2.5, 2.5), (S, 0.0, 0.0)]
)
def test_the_printed_annulus_lets_an_alien_in(distance, disc, annulus):
    world = ZoneWorld(aliens=(Alien((distance, 0.0)),))
    for name, push in (("disc", disc), ("annulus", annulus)):
        law = ZoneFlocking(RADII, world=world, surveillance=name)
        assert law.behaviours([[0.0, 0.0]], [[0.0, 0.0]])["strategic"].tolist() == [[-push, 0.0]]


def test_agents_that_heed_nobody_in_reach_feel_nothing_of_a_mean():
    w = ZoneWeights(cohesion=((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0)))
    parts = ZoneFlocking(RADII, w).behaviours([[0.0], [2.0], [90.0]], np.zeros((3, 1)))
    assert parts["cohesion"].tolist() == [[0.0], [-0.5], [0.0]]  # of agent 0 only the far one counts


def test_saturation_has_its_limit_at_zero_and_no_seam():
    assert saturation(0.0, 2.0) == 1.0
    for x in (1e-9, 9.99e-5, 1.0001e-4, 0.3, 7.0):
        assert isclose(saturation(2.0 * x, 2.0), tanh(x) / x, rel_tol=3e-16)


@pytest.mark.parametrize("order", ["synchronous", "sequential"])
@pytest.mark.parametrize("bound", ["clip", "tanh"])
def test_one_step_is_the_papers(order, bound):
    law = ZoneFlocking(RADII, order=order, speed_bound=bound, u_max=2.0, v_max=3.5, dt=0.2)
    q, v, _, _ = a_state(2, 5)
    v *= 3.0
    new_q, new_p, u, memory = law.step(0.0, q, v, law.start(q, v))
    x, p = q.copy(), v.copy()
    frozen = x.copy(), p.copy()
    for i in range(len(q)):
        seen = (x, p) if order == "sequential" else frozen
        total = sum(part[i] for part in law.behaviours(*seen).values())
        size = float(np.linalg.norm(total))
        wanted = 2.0 * tanh(size / 2.0) * total / size
        np.testing.assert_allclose(u[i], wanted, rtol=1e-13)
        w = p[i] + 0.2 * wanted
        speed = float(np.linalg.norm(w))
        w = w * (3.5 * tanh(speed / 3.5) / speed if bound == "tanh" else min(1.0, 3.5 / speed))
        x[i], p[i] = x[i] + 0.2 * w, w
    np.testing.assert_allclose(new_p, p, rtol=1e-13)
    np.testing.assert_allclose(new_q, x, rtol=1e-13)
    np.testing.assert_allclose(memory["heading"], v / np.linalg.norm(v, axis=1, keepdims=True), rtol=1e-15)
    assert np.linalg.norm(v, axis=1).max() > 3.5, "no agent was fast enough to test the bound"


def test_populations_and_fragments_against_matrices():
    q = np.random.default_rng(3).uniform(0.0, 14.0, (4, 8, 2))
    d = np.linalg.norm(q[:, :, None] - q[:, None], axis=3) + 1e9 * np.eye(8)
    counts = populations(q, *(np.full(8, x) for x in (R, C, A)))
    edges = [(0.0, R), (R, C), (C, A)]
    wanted = np.stack([((d > low) & (d <= high)).sum(axis=(1, 2)) / 8.0 for low, high in edges], axis=1)
    np.testing.assert_allclose(counts, wanted, rtol=1e-14)
    assert wanted.max() > 0.5
    for k in range(4):
        reached = np.linalg.matrix_power((d[k] <= A) + np.eye(8), 8) > 0
        sizes = reached.sum(axis=1)
        assert fragments(q, np.full(8, A))[k].tolist() == [round(sum(1.0 / sizes)), sizes.max()]


def test_a_flock_that_draws_together_until_no_cells_are_left_is_stepped_as_from_step_to_step():
    """Cells serve at first; when all are near each other nobody may be summed twice, or left out."""
    law = ZoneFlocking(weights=ZoneWeights(separation=0.5, cohesion_gain=2.0, alignment_gain=0.0, speed=0.0))
    q, p = np.random.default_rng(0).uniform(0.0, 18.0, (100, 2)), np.zeros((100, 2))
    run, memory = simulate(law, q, p, (0.0, 4.0)), law.start(q, p)
    for k in range(1, len(run.t)):
        q, p, _, memory = law.step(float(run.t[k - 1]), q, p, memory)
        np.testing.assert_array_equal(run.q[k], q)
    assert (
        sort_into_cells.py_func(run.q[0], law.radii.a).start.size
        > 0
        == sort_into_cells.py_func(run.q[-1], law.radii.a).start.size
    )


def test_instants_are_counted_each_by_itself():
    wide, dense = np.random.default_rng(1).uniform(0.0, [[[60.0, 60.0]], [[4.0, 4.0]]], (2, 100, 2))
    a = np.full(100, 5.0)
    together = fragments(np.stack([wide, dense]), a), populations(np.stack([wide, dense]), a / 9.0, a / 3.0, a)
    for k, q in enumerate((wide, dense)):
        np.testing.assert_array_equal(together[0][k], fragments(q[None], a)[0])
        np.testing.assert_array_equal(together[1][k], populations(q[None], a / 9.0, a / 3.0, a)[0])
    assert together[0][1].tolist() == [1, 100]


@pytest.mark.parametrize("n", [1, 2, 9, 40])
def test_small_flocks_are_counted_as_large_ones(n, monkeypatch):
    rng = np.random.default_rng(n)
    q, a = 1.5 * np.sqrt(n) * rng.normal(size=(50, n, 2)), rng.uniform(0.5, 2.5, n)
    small = fragments(q, a)
    monkeypatch.setattr(zone_counts, "DENSE_MAX", 0)
    np.testing.assert_array_equal(small, fragments(q, a))
    assert n == 1 or len(np.unique(small[:, 0])) > 1


def test_one_who_sees_farther_links_both():
    q = np.array([[[0.0], [4.0]]])
    assert fragments(q, np.array([1.0, 5.0]))[0].tolist() == [1, 2]
    assert fragments(q, np.array([1.0, 3.0]))[0].tolist() == [2, 1]


def test_an_alien_hunts_the_nearest_in_reach_and_keeps_to_its_triangle():
    home = SimplePolygon([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)])
    law = ZoneFlocking(
        RADII, world=ZoneWorld(aliens=(Alien((1.0, 1.0), home), Alien((30.0, 30.0)))), desired_speed=1e-9
    )
    q, v = np.array([[7.0, 7.0], [9.0, 1.0]]), np.zeros((2, 2))
    *_, series = law.iterate(0.0, q, v, law.start(q, v), 30)
    alien = series["alien"]
    np.testing.assert_allclose(alien[0, 0], [1.15, 1.0], rtol=1e-15)  # dt · 1.5 towards the nearer agent
    assert alien[:, 0].sum(axis=1).max() <= 4.0 + 1e-12
    np.testing.assert_allclose(alien[-1, 0].sum(), 4.0, rtol=1e-12)  # on the slanted side, as near as it gets
    assert (alien[:, 1] == 30.0).all(), "an agent out of reach was hunted"


def test_detection_is_closed():
    law = ZoneFlocking(RADII, world=ZoneWorld(aliens=(Alien((0.0, 0.0)),)))
    for x, moves in ((9.0, True), (np.nextafter(9.0, 10.0), False)):
        q = np.array([[x, 0.0]])
        memory = law.start(q, 0.0 * q)
        # the agent is at rest and nobody pushes it: it is where it was when the alien looks
        assert bool(law.step(0.0, q, 0.0 * q, memory)[3]["alien"].any()) is moves


def test_an_alien_on_its_prey_stays_there():
    """The way to it has no direction: 0/0 would end the run."""
    law = ZoneFlocking(RADII, world=ZoneWorld(aliens=(Alien((0.0, 0.0)),)))
    q = np.zeros((1, 2))
    assert law.step(0.0, q, q, law.start(q, q))[3]["alien"].tolist() == [[0.0, 0.0]]


def trembling(w, n, aliens, seed, step, share):
    """The weights of a step: a number of its own for each agent, whom it is about, and behaviour."""

    def factor(i, j, behaviour):
        return 1.0 + share * uniform(seed, step, i, j, BEHAVIOURS.index(behaviour))

    def pairs(name, of, many):
        return tuple(tuple(of[i][j] * factor(i, j, name) for j in range(many)) for i in range(n))

    return ZoneWeights(
        separation=pairs("separation", w.separation, n),
        cohesion=pairs("cohesion", w.cohesion, n),
        alignment=pairs("alignment", w.alignment, n),
        alien=pairs("strategic", w.alien, aliens),
        speed=tuple(w.speed[i] * factor(i, 0, "speed") for i in range(n)),
        obstacle=tuple(w.obstacle[i] * factor(i, 0, "obstacle") for i in range(n)),
        cohesion_gain=w.cohesion_gain,
        alignment_gain=w.alignment_gain,
    )


def test_trembling_weights_are_other_weights():
    q, v, aliens, rng = a_state(2, 4)
    w, world = weights_of(len(q), 2, rng), ZoneWorld((), Box((-1.0, -1.0), (8.0, 8.0)), tuple(map(Alien, aliens)))
    noise = ZoneNoise(weights=0.8, seed=11)
    law = ZoneFlocking(RADII, w, world, noise=noise)
    for step in (0, 5):
        other = trembling(w, len(q), 2, 11, step, 0.8)
        found = law.behaviours(q, v, dict(law.start(q, v)) | {"step": step})
        wanted = transcription(q, v, aliens, other, printed=False)
        wanted["obstacle"] = ZoneFlocking(RADII, other, world).behaviours(q, v)["obstacle"]
        for name in BEHAVIOURS:
            assert np.abs(wanted[name]).max() > 0.1
            np.testing.assert_allclose(found[name], wanted[name], rtol=1e-12, atol=2e-14, err_msg=name)


def test_gusts_come_before_the_bound():
    law = ZoneFlocking(RADII, v_max=1.5, noise=ZoneNoise(velocities=0.3, seed=2))
    q, v, _, _ = a_state(2, 6)
    new_q, new_p, u, memory = law.step(0.0, q, v, dict(law.start(q, v)) | {"step": np.array(4.0)})
    gust = [[0.3 * 3.0**0.5 * uniform(2, 4, i, k, 6) for k in range(2)] for i in range(len(q))]
    p = v + 0.1 * u + np.array(gust)
    speed = np.linalg.norm(p, axis=1, keepdims=True)
    assert (speed > 1.5).any()
    np.testing.assert_allclose(new_p, p * np.minimum(1.0, 1.5 / speed), rtol=1e-13)
    np.testing.assert_allclose(new_q, q + 0.1 * new_p, rtol=1e-13)
    assert memory["step"] == 5.0


def test_radii_grow_while_nobody_is_in_them():
    """Remark 2, by its definition in plain loops; what a radius attracts is what a law with that radius attracts."""
    law = ZoneFlocking(ZoneRadii(R, c=C, a=A), growth=4.0)
    q = np.array([[0.0, 0.0], [1.0, 0.0], [13.0, 0.0], [40.0, 3.0], [44.0, 3.0]])
    v = np.array([[1.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
    x, memory, reach, grown = q, law.start(q, v), np.full(5, A), 0.0
    for _ in range(120):
        fixed = ZoneFlocking(ZoneRadii(R, c=C, a=tuple(reach.tolist())))
        for name, part in law.behaviours(x, v, memory).items():
            np.testing.assert_array_equal(part, fixed.behaviours(x, v)[name])
        d = np.linalg.norm(x[:, None] - x, axis=2)
        for i in range(5):
            seen = [d[i, j] for j in range(5) if R < d[i, j] <= reach[i]]
            reach[i] = A if seen and min(seen) <= A else reach[i] if seen else reach[i] + 0.1 * 4.0
        x, v, _, memory = law.step(0.0, x, v, memory)
        np.testing.assert_allclose(memory["reach"], reach, rtol=1e-14)
        grown = max(grown, reach.max())
    assert grown > 1.5 * A
    assert (memory["reach"] == A).any(), "nobody came back to a"


@pytest.mark.parametrize("length", ["conflict", "attraction", "speed"])
@pytest.mark.parametrize("force", ["repulsive", "reaching", "literal"])
def test_walls_by_the_altitude_of_the_zone(length, force):
    """The triangle of each agent against each wall, corner by corner."""
    low, high, half = 0.0, 20.0, 0.5 * C
    law = ZoneFlocking(
        RADII, world=ZoneWorld(box=Box((low, low), (high, high))), zone_length=length, obstacle_force=force
    )
    rng = np.random.default_rng(1)
    q, angle = rng.uniform(low, high, (60, 2)), rng.uniform(0.0, 2.0 * np.pi, 60)
    h = np.column_stack([np.cos(angle), np.sin(angle)])
    v = h * rng.uniform(0.1, 5.0, (60, 1))  # of some more than v^max = 4
    speed = np.linalg.norm(v, axis=1)
    depth = {"conflict": C + 0.0 * speed, "attraction": A + 0.0 * speed}.get(
        length, np.array([R + (A - R) * min(1.0, x / 4.0) for x in speed])
    )
    np.testing.assert_allclose(law.altitudes(v), depth, rtol=1e-14)
    wanted = np.zeros_like(q)
    for i in range(60):
        across = half * np.array([h[i, 1], -h[i, 0]])
        corners = [q[i] + depth[i] * h[i], q[i] + across, q[i] - across]
        for axis in range(2):
            for wall, normal in ((low, -1.0), (high, 1.0)):
                if not any(normal * (corner[axis] - wall) > 0.0 for corner in corners):
                    continue
                gap = normal * (wall - q[i, axis]) - (depth[i] if force == "reaching" else C)
                wanted[i, axis] += 5.0 * normal * (gap if force == "literal" else min(0.0, gap))
    found = law.behaviours(q, v)["obstacle"]
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-13)
    assert np.abs(wanted).max() > 1.0


def meet(a, b, c, d):
    """Whether two segments in general position cross, by their parameters."""
    s, t = np.linalg.solve(np.column_stack([b - a, c - d]), c - a)
    return 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0


@pytest.mark.parametrize("trigger", ["exact", "three-segments"])
def test_edges_are_summed_with_21(trigger):
    """Each edge that the zone meets has a term at its own closest point; (8) has one for the whole polygon."""
    corners = np.array([(0.0, 0.0), (2.5, -0.4), (3.0, 3.0), (0.3, 2.2)])
    world = ZoneWorld((SimplePolygon(corners.tolist()),))
    laws = {
        name: ZoneFlocking(RADII, world=world, trigger=trigger, polygons=name, obstacle_force="literal")
        for name in ("each", "nearest")
    }
    rng = np.random.default_rng(0)
    q, angle = rng.uniform(-4.0, 7.0, (400, 2)), rng.uniform(0.0, 2.0 * np.pi, 400)
    q, angle = (x[world.clearance(q) > 0.01] for x in (q, angle))
    h, counted = np.column_stack([np.cos(angle), np.sin(angle)]), []
    wanted = np.zeros_like(q)
    for i, x in enumerate(q):
        across = 0.5 * C * np.array([h[i, 1], -h[i, 0]])
        tip, right, left = x + C * h[i], x + across, x - across
        sides = [(x, tip), (right, left)] if trigger != "exact" else [(tip, right), (right, left), (left, tip)]
        terms = []
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            inner = np.linalg.solve(np.column_stack([right - tip, left - tip]), start - tip)
            held = trigger == "exact" and inner.min() >= 0.0 and inner.sum() <= 1.0
            if held or any(meet(start, end, *side) for side in sides):
                share = np.clip((x - start) @ (end - start) / ((end - start) @ (end - start)), 0.0, 1.0)
                gap = start + share * (end - start) - x
                terms.append((np.linalg.norm(gap), gap))
        counted.append(len(terms))
        wanted[i] = sum(5.0 * (d - C) * gap / d for d, gap in terms) if terms else 0.0
    found, one = (laws[name].behaviours(q, 0.1 * h)["obstacle"] for name in ("each", "nearest"))
    np.testing.assert_allclose(found, wanted, rtol=1e-11, atol=1e-11)
    assert {0, 1, 2} < set(counted)
    several = np.array(counted) > 1
    assert np.abs(found - one)[several].max() > 1.0
    assert not one[np.array(counted) == 0].any()


def test_a_zone_that_holds_a_whole_polygon_meets_its_edges():
    speck = SimplePolygon([(1.0, -0.1), (1.2, -0.1), (1.1, 0.1)])
    parts = [
        ZoneFlocking(RADII, world=ZoneWorld((speck,)), polygons=name).behaviours([[0.0, 0.0]], [[1.0, 0.0]])
        for name in ("each", "nearest")
    ]
    each, nearest = (part["obstacle"][0, 0] for part in parts)
    assert each < 2.0 * nearest < 0.0  # three edges, two of them as near as the polygon
