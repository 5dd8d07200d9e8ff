"""What a linearisation offers as methods, against closed forms of one agent and of two, and python-control."""

from math import inf, log, nan, sqrt

import control
import numpy as np
import pytest
from scipy.io import loadmat
from scipy.sparse import csr_array

from flockana import (
    Algorithm1,
    Algorithm2,
    AverageConsensus,
    Delayed,
    DirectedNet,
    Gains,
    NetConsensus,
    Sampled,
    StaticTarget,
    TaylorStep,
    VelocityLaw,
    linearise,
    stability,
)
from flockana.base.errors import ArgumentError
from flockana.stability.cost_estimates import ensure_maps, ensure_study
from flockana.stability.damp_table import damp_table
from flockana.stability.delay import DelaySystem, late_part
from tests.refused import refused

K, D = 4.0, 1.0
ONE = linearise(Algorithm2(gains=Gains(c1_gamma=K, c2_gamma=D), target=StaticTarget((0.0,))), [[0.0]])
CHAIN = linearise(NetConsensus([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], velocity=2.0), np.zeros((3, 1)))


def test_damp_is_the_table_that_engineers_know():
    """s = −½ ± j √3.75: ω_n = 2, ζ = ¼, 1/σ = 2, ln 50/σ."""
    table = ONE.damp()
    assert list(table.columns) == ["pole", "damping ratio", "natural frequency", "time constant", "settling time"]
    assert table["pole"].tolist() == pytest.approx([-0.5 + 1j * sqrt(3.75), -0.5 - 1j * sqrt(3.75)])
    np.testing.assert_allclose(table.iloc[:, 1:], [[0.25, 2.0, 2.0, 2.0 * log(50.0)]] * 2, rtol=1e-12)
    natural, ratio, _ = control.damp(ONE.state_space, doprint=False)
    np.testing.assert_allclose(table["natural frequency"], natural)
    np.testing.assert_allclose(table["damping ratio"], ratio)
    assert ONE.damp(settled=0.05)["settling time"].tolist() == pytest.approx([2.0 * log(20.0)] * 2)


RING = linearise(AverageConsensus([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.zeros((3, 1)))


def test_a_law_of_first_order_has_modes_and_margins():
    """x' = −L x on a ring of three: λ = 0, −3/2 ± j √¾; delays to (π/2 − π/6)/√3, periods to 2·1.5/3 = 1."""
    poles = np.array([-1.5 - 1j * sqrt(0.75), -1.5 + 1j * sqrt(0.75)])
    np.testing.assert_allclose(RING.eigenvalues, [0.0, *poles], atol=1e-12)
    assert (RING.zero_modes, RING.stable, len(RING.modes)) == (1, True, 1)
    table = RING.damp()
    assert table["damping ratio"].tolist()[1:] == pytest.approx([sqrt(0.75)] * 2)
    assert RING.delay_margin().delay == pytest.approx((np.pi / 3.0) / sqrt(3.0), rel=1e-9)
    assert RING.sampling_margin().period == pytest.approx(1.0, rel=1e-6)
    assert RING.delay_margin(sampled=0.2).delay < RING.delay_margin().delay
    # broken at one agent S = det(s − A₀)/det(s − A), A₀ without its row
    omega = np.geomspace(1e-3, 1e2, 4000)
    s = 1j * omega
    sensitivity = s * (s + 1.0) ** 2 / (s * (s**2 + 3.0 * s + 3.0))
    margins = RING.robustness().loops[0]
    assert margins.sensitivity == pytest.approx(max(1.0, np.abs(sensitivity).max()), rel=1e-6)
    assert margins.disk == pytest.approx(1.0 / np.abs(sensitivity - 0.5).max(), rel=1e-6)
    assert RING.transient_growth().growth == 1.0  # a normal matrix
    follower = linearise(AverageConsensus([[0.0, 0.0], [1.0, 0.0]]), np.zeros((2, 1))).modes[0].shape
    np.testing.assert_allclose(np.abs(follower.ravel()), [0.0, 1.0], atol=1e-12)  # what hears moves, not what is heard
    np.testing.assert_allclose(
        RING.response("v0_x", "q1_x", [1.0]).complex.ravel(), np.linalg.inv(1j * np.eye(3) - RING.A)[1, 0]
    )


def test_a_chain_of_first_order_grows_before_it_decays_and_its_poles_are_exact():
    """x_k' = 5 x_{k−1} − x_k: −1 eleven times, on agents in any order; ‖e^{At}‖ by exponentials of the followers."""
    from scipy.linalg import expm

    class Chain(VelocityLaw):
        matrix = 5.0 * np.eye(12, k=-1)[1:, 1:] - np.eye(11)
        functions = ()

        def velocity(self, t, q):
            return self.matrix @ q

        def slopes(self, t, q):
            return csr_array(self.matrix)

    chain = linearise(Chain(), np.zeros((11, 1)))
    assert chain.decay_rate == pytest.approx(1.0, abs=1e-9)
    sizes = [np.linalg.norm(expm(Chain.matrix * t), 2) for t in np.linspace(8.0, 12.0, 81)]
    assert chain.transient_growth().growth == pytest.approx(max(sizes), rel=1e-3)


def test_a_late_law_of_first_order_is_refused_by_name():
    with pytest.raises(
        ArgumentError, match=r"Delayed is around a law of first order: expected that law itself; linear"
    ):
        linearise(Delayed(RING.law, 0.1), np.zeros((3, 1)))


ASKS = {
    "the delay margin of 1 coordinates": lambda limit: CHAIN.delay_margin(delayed="neighbours", limit=limit),
    "the delay margin of a sampled flock of 3": lambda limit: CHAIN.delay_margin(sampled=0.1, limit=limit),
    "the modes of 3 agents": lambda limit: CHAIN.sampling_margin(limit=limit),
    "the sampling margin of a delayed flock of 3": lambda limit: CHAIN.sampling_margin(delay=0.1, limit=limit),
    "the margins of all loops of 3": lambda limit: CHAIN.robustness(limit=limit),
    "the transient growth of 3": lambda limit: CHAIN.transient_growth(limit=limit),
    "the norms of 3": lambda limit: CHAIN.norms(limit=limit),
    "the string gains of 3": lambda limit: CHAIN.string_gains(limit=limit),
}


@pytest.mark.parametrize(("work", "ask"), ASKS.items(), ids=ASKS)
def test_long_work_is_refused_with_its_estimate(work, ask):
    with pytest.raises(ArgumentError, match=rf"{work}.* would take about [0-9.e-]+ s and .* MB .* limit = 1e-12 s"):
        ask(1e-12)


def test_estimates_of_a_thousand_agents_in_the_plane():
    with pytest.raises(ArgumentError, match=r"2000 coordinates would take about 4.8e\+06 s and 4e\+03 MB"):
        ensure_study("the margins of all loops", 2000, 600.0)
    ensure_study("the transient growth", 400, 600.0)
    with pytest.raises(ArgumentError, match=r"10 coordinates would take about 0.002 s and 0.86 MB"):
        ensure_maps("a search", 10, np.array([4.0, 8.0]), 1e-3)  # 9e-10 · (80³ + 120³), and 6e-5 · 120²


def test_damp_shows_every_pole_once():
    table = CHAIN.damp()
    assert len(table) == 6
    assert table["pole"].tolist() == pytest.approx(sorted(CHAIN.eigenvalues.tolist(), key=abs), abs=1e-6)
    assert table.index[:2].tolist() == ["translation x", "drift"]
    assert np.isnan(table["damping ratio"].iloc[0])
    grows = damp_table([("up", 1.0 + 0j)])
    assert str(grows).split() == [*" ".join(grows.columns).split(), "up", "1+0j", "-1", "1", "inf", "inf"]  # all of it
    assert grows["time constant"].tolist() == [inf]
    step = damp_table([("z", -0.5 + 0j), ("end", 0j)], dt=0.1)
    assert step["natural frequency"].tolist() == pytest.approx([abs(complex(log(0.5), np.pi)) / 0.1, inf])
    assert nan not in step["damping ratio"].tolist()


def test_damp_of_a_map_tells_its_multipliers():
    """c1γ = 4, c2γ = 1 held for 0.2: z² − 1.72 z + 0.88 = 0, ζ ω_n = −ln √0.88/0.2."""
    held = linearise(Sampled(ONE.law, 0.2), ONE.q)
    table = held.damp()
    roots = np.roots([1.0, 0.2 + 0.08 - 2.0, 1.0 - 0.2 + 0.08])
    assert table["pole"].tolist() == pytest.approx(sorted(roots.tolist(), key=lambda z: -z.imag))
    np.testing.assert_allclose(1.0 / table["time constant"], -log(0.88) / 0.4, rtol=1e-12)


def test_structural_modes_leave_the_centre_out():
    pair = linearise(Algorithm2(target=StaticTarget((0.0,))), [[-3.5], [3.5]], allow_residual=True)
    assert [mode.name for mode in pair.structural_modes] == ["breathing"]
    assert pair.structural_decay_rate == pair.structural_modes[0].decay_rate


def test_margins_of_one_agent_are_closed_forms():
    assert ONE.delay_margin().delay == pytest.approx(stability.scalar_margin(K, D).delay, rel=1e-12)
    assert ONE.sampling_margin().period == stability.scalar_period(K, D)[0]
    # the place alone late: ω² = K e^(−jωτ) + jωD ..., |ω² − jωD| = K
    omega = sqrt(0.5 * (-D * D + sqrt(D**4 + 4.0 * K * K)))
    margin = ONE.delay_margin(carries="positions")
    assert margin.frequency == pytest.approx(omega, rel=1e-12)
    assert margin.delay == pytest.approx(np.arctan2(omega * D, omega * omega) / omega, rel=1e-12)
    # the velocity alone late: K − ω² + jωD e^(−jωτ) = 0
    margin = ONE.delay_margin(carries="velocities")
    turn = [0.5 * (sign * D + sqrt(D * D + 4.0 * K)) for sign in (-1.0, 1.0)]
    delays = [float(np.angle(-1j * w * D / (K - w * w))) % (2.0 * np.pi) / w for w in turn]
    assert margin.delay == pytest.approx(min(delays), rel=1e-9)


def test_links_that_are_late_one_by_one():
    """A chain: each link by itself is s² + (2s + 1) e^(−sτ); one that does not exist adds nothing."""
    exact = stability.scalar_margin(1.0, 2.0).delay
    assert CHAIN.delay_margin(delayed="pairs", links=[(2, 1)]).delay == pytest.approx(exact, rel=1e-9)
    assert CHAIN.delay_margin(delayed="pairs", links=[(0, 2)]).delay == inf
    assert CHAIN.delay_margin(delayed="neighbours").delay == inf  # block triangular: its own state is prompt
    k = np.array([[2.0, -2.0, 0.0], [-1.0, 4.0, -3.0], [0.0, -5.0, 6.0]])
    late = late_part(k, 1, "pairs", [(1, 2), (0, 1)])
    np.testing.assert_array_equal(late, [[2.0, -2.0, 0.0], [0.0, 3.0, -3.0], [0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(k - late_part(k, 1, "pairs"), np.diag([0.0, 0.0, 1.0]))  # 1 of a pull of its own


def test_a_root_that_passes_zero_without_a_swing():
    """s² + 2s − 1 + e^(−sτ) has the root 0 always, and a second one at τ = 2: s (2 − τ) + ….

    Without damping the drift itself grows at once: s² + s − … .
    """
    one, blank = np.eye(1), np.zeros((1, 1))
    margin = stability.delay_margin(DelaySystem((-one, 2.0 * one), (one, blank), neutral=1))
    assert margin.delay == pytest.approx(2.0, rel=1e-9)
    assert margin.frequency == 0.0
    roots = [
        stability.rightmost_roots(DelaySystem((-one, 2.0 * one), (one, blank), 1), tau, count=1)[0].real
        for tau in (1.9, 2.1)
    ]
    assert roots[0] < 0.0 < roots[1]
    assert stability.delay_margin(DelaySystem((-one, blank), (one, blank), neutral=2)).delay == 0.0


def test_norms_and_margins_of_directed_nets():
    """Agent 0 follows agent 1 and not the other way round: e'' = −k e − d e' + f0 − f1, the shape is e/√2."""
    law = DirectedNet(Algorithm1(gains=Gains(c1_alpha=0.02, c2_alpha=1.0)), (8.4, 3.0))
    flock = linearise(law, [[0.0], [7.0]])
    k, d = (float(part.toarray()[0, 0]) for part in (flock.stiffness, flock.damping))
    norms = flock.norms()
    assert norms.h2 == pytest.approx(1.0 / sqrt(2.0 * d * k), rel=1e-9)
    assert flock.delay_margin(delayed="pairs").delay == pytest.approx(stability.scalar_margin(k, d).delay, rel=1e-9)


def test_a_response_by_names():
    """From the γ-agent's place to the centre: c1/(s² + c2 s + c1); from a force: 1/(…)."""
    response = ONE.response("qr_x", "qc_x", [0.5, 2.0])
    s = 1j * np.array([0.5, 2.0])
    np.testing.assert_allclose(response.complex.ravel(), K / (s * s + D * s + K), rtol=1e-12)
    assert (response.input_labels, response.output_labels) == (["qr_x"], ["qc_x"])
    whole = ONE.response("f0_x", "qc_x")
    assert whole.omega[0] < 0.1 * 2.0 < 2.0 * 10.0 < whole.omega[-1]


def test_the_plant_is_closed_again_by_the_law():
    """A − B F with F = [K D] of the inputs that were opened is the flock."""
    plant = CHAIN.plant([1])
    assert (plant.ninputs, plant.input_labels, plant.state_labels[:2]) == (1, ["u1_x"], ["q0_x", "q1_x"])
    rows = np.hstack([CHAIN.stiffness.toarray(), CHAIN.damping.toarray()])[[1]]
    np.testing.assert_allclose(plant.A - plant.B @ rows, CHAIN.A)
    assert not CHAIN.plant().A[3:].any()
    assert CHAIN.plant(["u2_x", "u0_x"]).B[3:].tolist() == [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]
    gain = control.lqr(ONE.plant(), np.eye(2), np.eye(1))[0]  # Riccati: k² + 2 · 0 … of a double integrator: (1, √3)
    np.testing.assert_allclose(np.asarray(gain), [[1.0, sqrt(3.0)]], rtol=1e-9)


def test_studies_of_nets_are_those_of_the_functions():
    heard = CHAIN.string_gains()
    assert heard.gains[2] == pytest.approx(heard.gains[1] ** 2, rel=1e-8)
    assert (CHAIN.passivity().passive, ONE.passivity().passive) == (False, True)
    assert ONE.transient_growth().growth == stability.transient_growth(ONE).growth
    assert ONE.loss_margin(0.1, on_loss="hold") == stability.loss_margin(ONE, 0.1, on_loss="hold")


def test_a_matlab_file(tmp_path):
    CHAIN.to_mat(tmp_path / "flock.mat")
    read = loadmat(tmp_path / "flock.mat")
    np.testing.assert_array_equal(read["A"], CHAIN.state_space.A)
    assert [str(name[0]) for name in read["inputs"].ravel()] == CHAIN.state_space.input_labels


test_bad_input = refused(
    (lambda: ONE.response("f9_x", "qc_x"), "unknown input 'f9_x'"),
    (lambda: ONE.plant([1]), "inputs = .1.: expected different agents from 0 to 0"),
    (lambda: ONE.plant(["f0_x"]), "unknown input 'f0_x'"),
    (lambda: ONE.damp(settled=1.0), "settled = 1: expected a share"),
    (lambda: ONE.to_mat("flock.txt"), "expected a name that ends in .mat"),
    (lambda: ONE.delay_margin(links=[(0, 1)]), 'links: expected delayed="pairs" or "neighbours"'),
    (lambda: CHAIN.delay_margin(delayed="pairs", links=[(0, 3)]), "expected pairs of two different agents from 0 to 2"),
    (lambda: CHAIN.delay_margin(delayed="pairs", links=[0, 1]), "expected pairs .i, j. of agents"),
    (lambda: ONE.delay_margin(carries="noise"), "unknown quantity that is late 'noise'"),
    (lambda: stability.delay_system(TaylorStep(Algorithm1(), 0.1), [[0.0], [7.0]]), "TaylorStep is a map"),
    (
        lambda: stability.delay_system(AverageConsensus(np.eye(2)[::-1]), [[7.0], [7.0]]),
        "AverageConsensus is of first order",
    ),
    (lambda: DelaySystem((np.eye(2), np.eye(3)), (np.eye(2),) * 2), r"matrices of shapes \(2, 2\), \(3, 3\)"),
    (lambda: DelaySystem((np.eye(1), np.eye(1)), (nan * np.eye(1),) * 2), "a number that is not finite"),
)
