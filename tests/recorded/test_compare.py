"""A recording held against a law: what it explains, and the errors of other implementations, each in a sentence."""

import re
from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.base.vector_norms import lengths
from flockana.recorded.law_contributions import contributions, remainder, variants
from flockana.recorded.one_step_predictions import kinematic_scheme, scheme_by_law
from flockana.recorded.recording import recording_of
from flockana.sources.isola_2024.laws import MSNDiscretisation
from tests.recorded.written import LAW, P0, Q0, own_acceleration, own_run
from tests.refused import refused

T = np.linspace(0.0, 2.0, 101)


def recorded(**faults):
    q, p = own_run(T, **faults)
    return fl.Recording(T, q, p, bound=1e-6)


def test_a_users_own_right_code_is_explained_and_its_gains_are_found():
    seen = fl.compare(recorded(), LAW)
    assert seen.basis == "steps"
    assert seen.explained > 0.9999
    assert seen.findings == ()
    found = {one.symbol: one.found for one in seen.shares}
    assert found["c1α"] == pytest.approx(30.0, rel=2e-3)
    assert found["c2γ"] == pytest.approx(2.0 * np.sqrt(1.1), rel=2e-3)
    assert sum(one.share for one in seen.shares) == pytest.approx(1.0, abs=1e-3)


def test_accelerations_that_no_gain_scales_are_the_laws_too():
    """The γ-agent's own acceleration and a thrust, both far from 0."""
    circle = fl.CircleTarget((0.0, 0.0), 20.0, 0.3)
    for law in (fl.compose(navigation=circle, feedforward=True), fl.compose(navigation=circle, speed=(0.5, 0.1))):
        run = fl.simulate(law, Q0, P0, (0.0, 1.0), t_eval=np.linspace(0.0, 1.0, 101))
        assert fl.compare(recording_of(run), law).explained > 1.0 - 1e-12


def test_two_errors_at_once_are_told_apart():
    texts = fl.compare(recorded(pull_per_axis=True, c2a=30.0), LAW).findings
    assert [text.split(" is ")[0] for text in texts] == ["the pull to the γ-agent", "velocity consensus"]


def test_recorded_accelerations_are_compared_at_the_samples():
    q, p = own_run(T)
    u = np.array([own_acceleration(*state) for state in zip(q, p, strict=True)])
    seen = fl.compare(fl.Recording(T, q, p, u), LAW)
    assert seen.basis == "accelerations"
    assert np.abs(seen.residual).max() < 1e-9 * np.abs(u).max()
    u[7, 3] += 5.0
    worst = fl.compare(fl.Recording(T, q, p, u), LAW).worst[0]
    assert worst == (pytest.approx(T[7]), "3", pytest.approx(5.0 * np.sqrt(2.0)))


def test_drag_and_feedforward_are_no_part_of_any_gain():
    target = fl.CircleTarget((0.0, 0.0), 10.0, 0.1)
    law = fl.compose(pair=LAW.alpha, navigation=target, feedforward=True, speed=(0.3, 0.1))
    rest, each = remainder(law), contributions(law)
    own = rest(0.0, Q0, P0) - (0.3 - 0.1 * (P0**2).sum(1)[:, None]) * P0
    np.testing.assert_allclose(own, np.array([[-10.0 * (0.2 * np.pi) ** 2, 0.0]] * len(Q0)), rtol=1e-12, atol=1e-12)
    total = rest(0.0, Q0, P0) + sum(one.stated * one.acts(0.0, Q0, P0) for one in each)
    np.testing.assert_allclose(total, law.acceleration(0.0, Q0, P0), rtol=1e-12, atol=1e-12)


SCHEMES = {
    "explicit Euler": fl.ExplicitEuler,
    "semi-implicit Euler": fl.SemiImplicitEuler,
    "Taylor steps": fl.TaylorStep,
}


@pytest.mark.parametrize(("name", "scheme"), SCHEMES.items())
def test_schemes_are_told_and_the_input_of_each_step_is_the_laws(scheme, name):
    run = fl.simulate(scheme(LAW, 0.01), Q0, P0, (0.0, 0.5))
    seen = fl.compare(fl.Recording(run.t, run.q, run.p), LAW)
    assert seen.findings == (f"steps are {name} of 0.01",)
    assert seen.explained > 1.0 - 1e-12
    assert fl.compare(fl.Recording(run.t, run.q, run.p), scheme(LAW, 0.01)).findings == seen.findings


def test_runge_kutta_steps_are_told():
    run = fl.simulate(LAW, Q0, P0, (0.0, 1.0), method="RK4", dt=0.04, t_eval=np.arange(26) * 0.04)
    assert "steps are Runge-Kutta steps (RK4) of 0.04" in fl.compare(fl.Recording(run.t, run.q, run.p), LAW).findings


def test_a_foreign_law_is_told_and_a_ranking_says_which_fits():
    rec = recorded()
    seen = fl.recognise(rec, {"mine": LAW, "no target": fl.Algorithm1(), "mean": fl.CuckerSmale()})
    assert seen.ranked[0][0] == "mine"
    assert seen.best is seen.ranked[0][1]
    other = fl.recognise(rec, {"mean": fl.CuckerSmale()})
    assert other.best is None
    assert "none fits" in str(other)
    assert "another law acts" in str(other.ranked[0][1])
    far = fl.compare(rec, fl.Algorithm2(target=fl.StaticTarget((900.0, 0.0))))
    assert far.explained < 0.0
    assert str(far).startswith("Algorithm2 explains nothing of the recorded accelerations")
    with pytest.raises(ArgumentError, match="expected laws by name"):
        fl.recognise(rec, {})
    flat = fl.Algorithm2(target=fl.StaticTarget((0.0,)))
    assert "expected equal dimensions" in fl.recognise(rec, {"flat": flat, "mine": LAW}).refused["flat"]


def test_under_noise_the_better_known_accelerations_are_compared_and_rough_ones_are_said_to_be():
    (q, p), rng = own_run(T), np.random.default_rng(0)
    noise, slip = rng.normal(0.0, 0.1, q.shape), rng.normal(0.0, 1e-4, q.shape)
    slips = np.where(np.arange(len(P0)) == 0, 3e-4, 1e-4) * np.ones((len(T), 1))  # noise is the usual one
    by_velocity = fl.compare(fl.Recording(T, q + noise, p + slip, sd=0.1, p_sd=slips), LAW)
    assert (by_velocity.basis, by_velocity.caution) == ("steps", "")
    assert by_velocity.noise == pytest.approx(np.sqrt(2.0) * 1e-4 / 0.02)
    by_position = fl.compare(fl.Recording(T, q + noise, p + 30.0 * noise, sd=0.1, p_sd=3.0), LAW)
    assert by_position.basis == "splines"
    assert "shares and gains are rough; fit(recording, law)" in str(by_position)


test_too_few_samples_are_refused = refused(
    (lambda: fl.compare(fl.Recording([0.0], Q0[None], P0[None]), LAW), "one sample without accelerations"),
    (lambda: fl.compare(fl.Recording([0.0, 1.0], np.stack([Q0, Q0])), LAW), "expected 4 or more"),
)


@pytest.mark.parametrize("size", [1.0, 2.0])
def test_the_forms_that_are_tried_are_those_that_their_findings_name(size):
    """Two agents (3, 4) apart or twice as far, where only a force that is cut off by the distance's own r_α is left."""
    alpha, x, v = fl.AlphaInteraction(), size * np.array([3.0, 4.0]), np.array([1.0, -2.0])
    s, near = 5.0 * size, size == 1.0
    inner = near * alpha.phi_alpha((np.sqrt(1.0 + 0.1 * s**2) - 1.0) / 0.1)
    forms = {
        "coordinate by coordinate": inner * x / np.sqrt(1.0 + 0.1 * x**2),
        "φ_α is given the distance": alpha.phi_alpha(s) * x / np.sqrt(1.0 + 0.1 * s**2),
        "n_ij is the unit vector": inner * x / s,
        "count alike in the consensus": near * v,
        "proportional to each coordinate's σ₁": -x / np.sqrt(1.0 + x**2),
        "bounded by σ₁ of the vector, not linear": -x / np.sqrt(1.0 + s**2),
        "is linear, not bounded by σ₁": -x,
    }
    q, p, found = np.array([x, 2.0 * x]), np.array([[0.0, 0.0], v]), {}
    for law in (fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), fl.Algorithm3(target=fl.StaticTarget((0.0, 0.0)))):
        found |= {variant.finding: variant.acts(0.0, q, p) for variant in variants(law)}
        assert ["not to the vector's" in text for text in found if "each coordinate" in text][-1] == isinstance(
            law, fl.Algorithm3
        )
    for text, expected in forms.items():
        (u,) = [u for finding, u in found.items() if text in finding][:1]
        np.testing.assert_allclose(u[0], expected, rtol=1e-12, atol=1e-12, err_msg=text)
        if "σ₁" not in text:
            np.testing.assert_allclose(u[1], -expected, rtol=1e-12, atol=1e-12, err_msg=text)


def test_shares_errors_and_ranks_are_those_of_one_regression():
    """u = 2 x + rest at the samples, x the law as a whole: the gain, its error over agents, and what is left."""
    law, rng = fl.CuckerSmale(), np.random.default_rng(2)
    q, p, rest = rng.normal(0.0, 2.0, (3, 9, 5, 2))
    x = np.array([law.acceleration(0.0, *state) for state in zip(q, p, strict=True)])
    u = 2.0 * x + 0.1 * rest
    seen = fl.compare(fl.Recording(T[:9], q, p, u), law)
    gain = np.sum(x * u) / np.sum(x**2)
    scores, squares = np.sum(x * (u - gain * x), axis=(0, 2)), np.sum(x**2, axis=(0, 2))
    error = np.sqrt(0.8 * np.sum((scores / (squares.sum() - squares)) ** 2))  # the jackknife's, of 5 agents
    assert seen.shares[0].found == pytest.approx(gain)
    assert seen.shares[0].error == pytest.approx(error)
    assert f"= {gain:.4g} ± {2.0 * error:.2g}, 1 in the law" in str(seen)
    assert seen.explained == pytest.approx(1.0 - np.sum((u - x) ** 2) / np.sum(u**2))
    assert seen.explained_refitted == pytest.approx(1.0 - np.sum((u - gain * x) ** 2) / np.sum(u**2))
    assert seen.to_dict()["explained"] == seen.explained
    np.testing.assert_allclose(seen.by_agent, np.sqrt(np.mean(np.sum((u - x) ** 2, axis=2), axis=0)))
    np.testing.assert_allclose(seen.by_time, np.sqrt(np.mean(np.sum((u - x) ** 2, axis=2), axis=1)))
    near = fl.CuckerSmale(replace(law.weight, strength=2.0 * law.weight.strength, decay=1.1 * law.weight.decay))
    exact = fl.recognise(fl.Recording(T[:9], q, p, 2.0 * x), {"near": near, "double": law})
    assert exact.best is exact.ranked[0][1]
    assert exact.ranked[1][1].explained > exact.best.explained == pytest.approx(0.75)
    assert str(exact).startswith("     100% (75% with its own gains)  double")
    half = x + rest * np.linalg.norm(x) / np.linalg.norm(rest)
    assert fl.recognise(fl.Recording(T[:9], q, p, half), {"double": law}).best is None


def test_forms_of_the_pull_bend_at_the_unit_of_length_of_the_law():
    law, q = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), np.array([[3.0, 4.0]])
    other = fl.rescale(law, length=1000.0)
    for one, two in zip(variants(law)[-2:], variants(other)[-2:], strict=True):
        np.testing.assert_allclose(two.acts(0.0, 1000.0 * q, q), 1000.0 * one.acts(0.0, q, q), rtol=1e-12)


def test_uneven_times_and_free_flight_show_no_scheme():
    run = fl.simulate(fl.ExplicitEuler(LAW, 0.01), Q0, P0, (0.0, 0.3))
    late = fl.Recording(run.t + 0.005 * (np.arange(31) > 7), run.q, run.p)
    flight = fl.Recording(T, Q0 + T[:, None, None] * P0, np.tile(P0, (len(T), 1, 1)))
    assert kinematic_scheme(late) is None
    assert kinematic_scheme(flight) is None
    run = fl.simulate(LAW, Q0, P0, (0.0, 1.0), method="RK4", dt=0.04, t_eval=np.arange(26) * 0.04)
    late = fl.Recording(run.t + 0.02 * (np.arange(26) > 7), run.q, run.p)
    assert scheme_by_law(late, LAW) is None


def test_a_recording_in_another_unit_of_time_is_refused_with_what_it_would_take():
    """In ms under a law in s: millions of steps from sample to sample, and no answer for minutes."""
    law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
    run = fl.simulate(
        law, [[0.0, 0.0], [7.5, 0.0]], [[0.1, 0.0], [0.0, 0.1]], (0.0, 4.0), t_eval=np.linspace(0, 4, 401)
    )
    rec = fl.Recording(run.t * 1e3, run.q, run.p * 1e-3, bound=1e-6)
    expected = r"401 samples over 4000, where the law's own time is 0\.\d+: following them takes \d\S* steps, expected"
    with pytest.raises(ArgumentError, match=expected):
        fl.verify("os-3", rec, law=law)
    assert fl.verify("os-3", fl.Recording(run.t, run.q, run.p, bound=1e-6), law=law).hypotheses


@pytest.mark.parametrize("factor", [10.0, 0.5])
def test_positions_that_move_otherwise_than_velocities_are_said_first(factor):
    """Velocities follow the law; positions move by a multiple of them, as with a wrong unit of time."""
    law, q, p = fl.CuckerSmale(), [Q0], [P0]
    for _ in T[1:]:
        q.append(q[-1] + factor * 0.02 * p[-1])
        p.append(p[-1] + 0.02 * law.acceleration(0.0, q[-2], p[-1]))
    texts = fl.compare(fl.Recording(T, q, p, bound=1e-9), law).findings
    assert len(texts) == 1
    assert float(texts[0].split(" times")[0].split()[-1]) == pytest.approx(factor, rel=0.02)
    right = fl.simulate(law, Q0, P0, (0.0, 2.0), t_eval=T)
    assert fl.compare(recording_of(right), law).findings == ()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("at", "factor", "text"),
    [
        (np.s_[:, 5], -1.0, r"of agent 5 move by -1\.0\d+ times"),
        (np.s_[:, :, 1], 1000.0, r"along y move by 0\.00101 times"),
        (np.s_[30:50], -1.0, r"from t = 0\.58 to 1 move by -0\.998\d times"),
    ],
    ids=["agent", "axis", "stretch"],
)
def test_one_agent_axis_or_stretch_whose_velocities_are_wrong_is_named(at, factor, text):
    (q, p), noise = own_run(T), np.random.default_rng(0).normal(0.0, 1e-3, (len(T), len(P0), 2))
    p[at] *= factor
    (finding,) = fl.compare(fl.Recording(T, q, p, bound=1e-6), LAW).findings
    assert re.match(f"positions {text} what velocities and times say: expected 1; all others agree", finding)
    noisy = fl.compare(fl.Recording(T, q + noise, p, bound=1e-2), LAW)
    assert re.match(f"positions {text.split(' move')[0]} move by", noisy.findings[0])


@pytest.mark.slow
@pytest.mark.parametrize("sd", [1e-3, 1e-2, 0.1, 1.0])
def test_no_agent_axis_or_stretch_is_named_by_chance(sd):
    (q, p), rng = own_run(T), np.random.default_rng(1)
    for _ in range(5):
        rec = fl.Recording(T, q + rng.normal(0.0, sd, q.shape), p + rng.normal(0.0, sd, q.shape), bound=5.0 * sd)
        assert "all others agree" not in str(fl.compare(rec, LAW).findings)


VICSEK = fl.HeadingAveraging(range=1.0, speed=0.3, dt=0.5, average="vectors")
FLOCK = np.random.default_rng(0).uniform(0.0, 4.0, (20, 2))
HEADINGS = np.random.default_rng(1).uniform(0.0, 6.2, 20)


@pytest.mark.parametrize("every", [1, 2])
def test_a_map_is_led_on_from_each_sample_to_the_next(every):
    rec = recording_of(fl.simulate(VICSEK, FLOCK, VICSEK.velocities(HEADINGS), (0.0, 10.0)))
    rec = rec.select(samples=slice(None, None, every))
    seen = fl.compare(rec, VICSEK)
    assert (seen.basis, seen.findings, len(seen.t)) == ("map", (), len(rec.t) - 1)
    assert seen.explained > 1.0 - 1e-12
    short = replace(VICSEK, range=0.5)
    q, p, u = rec.q, rec.p, np.diff(rec.p, axis=0) / np.diff(rec.t)[:, None, None]
    led = [short.step(0.0, a, b, short.start(a, b))[:2] for a, b in zip(q[:-1], p[:-1], strict=True)]
    if every == 1:
        own = np.array([(b - was) / 0.5 for (_, b), was in zip(led, p[:-1], strict=True)])
        np.testing.assert_allclose(fl.compare(rec, short).residual, u - own, atol=1e-12)
    ranking = fl.recognise(
        rec, {"slow": fl.CuckerSmale(), "short": short, "own": VICSEK, "dt": replace(VICSEK, dt=0.3)}
    )
    assert ranking.best is ranking.ranked[0][1]
    assert ranking.ranked[0][0] == "own"
    assert f"samples are {0.5 * every:g} apart at t = 0: expected whole steps of HeadingAveraging, dt = 0.3" in str(
        ranking
    )
    if every == 1:
        text = fl.compare(rec, replace(VICSEK, speed=0.2)).findings[0]
        assert text.startswith("positions move by 1.5 times what steps of HeadingAveraging say: expected 1")
    with pytest.raises(ArgumentError, match="without velocities: expected two or more with velocities"):
        fl.compare(fl.Recording(rec.t, rec.q), VICSEK)


def test_a_maps_noise_is_left_out_and_its_own_discretisation_is_no_law_stepped():
    noisy = replace(VICSEK, noise=0.5)
    rec = recording_of(fl.simulate(noisy, FLOCK, VICSEK.velocities(HEADINGS), (0.0, 20.0)))
    seen = fl.compare(rec, noisy)
    assert seen.findings == ("steps of HeadingAveraging are compared without its noise",)
    turns = 2.0 * np.arcsin(0.25 * lengths(seen.residual) / 0.3)  # chords of the headings' noise
    assert np.sqrt(np.mean(turns**2)) == pytest.approx(0.5 / np.sqrt(12.0), rel=0.05)
    law = MSNDiscretisation(fl.Algorithm1(), 0.02)
    run = fl.simulate(law, fl.lattice.triangular(7, 7.5), P0[:7], (0.0, 1.0))
    assert fl.compare(recording_of(run), law).explained == 1.0
    assert "another law acts" in fl.compare(recording_of(run), fl.Algorithm1()).findings[-1]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["steps", "splines", "bound"])
@pytest.mark.parametrize("seed", range(3))
def test_stated_noise_alone_is_no_finding_and_gains_hold_the_truth(kind, seed):
    """Errors of positions make the pair force too small by regression: 28.2 of 30 here, 0.26 by its scatter."""
    law, rng, t = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), np.random.default_rng(seed), np.arange(101) * 0.02
    q0 = fl.lattice.triangular(7, 7.0) + rng.normal(0.0, 0.8, (7, 2))
    run = fl.simulate(law, q0, rng.normal(0.0, 1.0, (7, 2)), (0.0, 2.0), t_eval=t)
    q, p = (x + rng.normal(0.0, 0.01, x.shape) for x in (run.q, run.p))
    given = {"bound": 0.05, "p_bound": 0.05} if kind == "bound" else {"sd": 0.01, "p_sd": 0.01}
    rec = fl.Recording(t, q, sd=0.01) if kind == "splines" else fl.Recording(t, q, p, **given)
    found = fl.compare(rec, law)
    assert found.findings == ()
    if kind == "splines":  # which round off what turns between two samples, and say so
        assert "rough" in found.caution
    else:
        assert all(abs(share.found - share.stated) <= 2.0 * share.error for share in found.shares)


def test_half_a_gain_is_a_finding_in_the_same_noise():
    law, rng, t = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), np.random.default_rng(0), np.arange(101) * 0.02
    q0 = fl.lattice.triangular(7, 7.0) + rng.normal(0.0, 0.8, (7, 2))
    run = fl.simulate(law, q0, rng.normal(0.0, 1.0, (7, 2)), (0.0, 2.0), t_eval=t)
    q, p = (x + rng.normal(0.0, 0.01, x.shape) for x in (run.q, run.p))
    stated = replace(law, gains=replace(law.gains, c1_alpha=2.0 * law.gains.c1_alpha))
    (text, *_) = fl.compare(fl.Recording(t, q, p, sd=0.01, p_sd=0.01), stated).findings
    gain = float(re.fullmatch(r"pair force is c1α = (.*) here, 60 in the law", text).group(1))
    assert gain == pytest.approx(28.0, abs=1.0)


@pytest.mark.parametrize("law", [fl.HeadingAveraging(), fl.ZoneFlocking()])
@pytest.mark.parametrize("sd", [1e-3, 1e-2])
def test_stated_noise_alone_is_no_finding_of_a_map(law, sd):
    rng = np.random.default_rng(0)
    q0, p0 = rng.uniform(0.0, 10.0, (20, 2)), rng.normal(0.0, 1.0, (20, 2))
    if isinstance(law, fl.HeadingAveraging):
        p0 *= law.speed / lengths(p0)[:, None]
    run = fl.simulate(law, q0, p0, (0.0, 30.0 * law.dt))
    noisy = [x + rng.normal(0.0, sd, x.shape) for x in (run.q, run.p)]
    found = fl.compare(fl.Recording(run.t, *noisy, sd=sd, p_sd=sd), law)
    assert found.basis == "map"
    assert found.findings == ()


def test_another_map_is_a_finding_in_little_noise():
    law, rng = fl.HeadingAveraging(), np.random.default_rng(0)
    q0, p0 = rng.uniform(0.0, 10.0, (20, 2)), rng.normal(0.0, 1.0, (20, 2))
    run = fl.simulate(law, q0, p0 * law.speed / lengths(p0)[:, None], (0.0, 30.0 * law.dt))
    noisy = [x + rng.normal(0.0, 1e-6, x.shape) for x in (run.q, run.p)]
    rec = fl.Recording(run.t, *noisy, sd=1e-6, p_sd=1e-6)
    assert "another law acts" in fl.compare(rec, replace(law, range=3.0)).findings[-1]
