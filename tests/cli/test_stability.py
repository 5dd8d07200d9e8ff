from math import sqrt

import pytest

from flockana import Algorithm2, Delayed, Gains, Sampled, StaticTarget, find_equilibrium, linearise, simulate
from flockana.base.errors import ArgumentError
from flockana.cli.stability import _with_flags
from flockana.lattice import hexagonal_patch
from flockana.stability.delay import scalar_margin

COMMAND = ("stability",)


def test_seven_agents_of_algorithm_1(found):
    one = found("hexagonal-patch:1", "--modes", 3)
    assert (one["law"], one["n"], one["m"], one["links"]) == ("Algorithm1", 7, 2, 12)
    assert one["zero modes"] == ["translation x", "translation y", "rotation"]
    assert one["drifting"] == ["translation x", "translation y"]
    assert one["centre poles"] is None
    assert one["splits into shape and centre"]
    assert one["spectral abscissa"] == pytest.approx(-1.96374976, rel=1e-8)
    assert [mode["name"] for mode in one["modes"]] == ["breathing", "2", "3"]
    assert one["modes"][0]["eigenvalue"] == pytest.approx([-1.96374976, 21.04250479], rel=1e-8)
    assert one["modes"][0]["damping ratio"] == pytest.approx(1.96374976 / abs(-1.96374976 + 21.04250479j), rel=1e-8)


def test_algorithm_2_has_the_poles_of_its_centre(found):
    one = found("hexagonal-patch:1", "--law", 2)
    assert one["zero modes"] == ["rotation"]
    assert one["drifting"] == []
    assert [re for re, _ in one["centre poles"]] == pytest.approx([-sqrt(1.1)] * 2, rel=1e-9)
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    modes = linearise(law, find_equilibrium(law, hexagonal_patch(1, 7.0))).modes
    rates = [mode.decay_rate for mode in modes[:8]]
    assert [mode["decay rate"] for mode in one["modes"]] == pytest.approx(rates, rel=1e-9)


def test_margins_and_norms_of_a_pair(found):
    """On a line two agents are one oscillator y'' = −2k y − 2c y' with y = x₁ − x₀, and its norms are closed forms."""
    one = found("line:2", "--delay", "--norms")
    rate, omega = one["modes"][0]["decay rate"], one["modes"][0]["frequency"]
    stiffness, damping = rate**2 + omega**2, 2.0 * rate
    margin = scalar_margin(stiffness, damping)
    assert one["delay margin, neighbours"]["delay"] > 2.0 * margin.delay
    for kind in ("all", "pairs"):
        assert one[f"delay margin, {kind}"]["delay"] == pytest.approx(margin.delay, rel=1e-9)
        assert one[f"delay margin, {kind}"]["frequency"] == pytest.approx(margin.frequency, rel=1e-9)
    assert one["H2"] == pytest.approx(1.0 / sqrt(2.0 * damping * stiffness), rel=1e-9)
    assert one["Hinf"] == pytest.approx(1.0 / (damping * sqrt(stiffness - 0.25 * damping**2)), rel=1e-8)


def test_what_is_printed(call):
    code, out, err = call("hexagonal-patch:1", "--law", 2, "--delay", "--norms")
    text = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "hexagonal-patch:1: stable off its zero modes" in text
    assert "zero modes rotation (all)" in text
    assert "centre's poles -1.0488, -1.0488" in text
    assert "spectral abscissa -1.04881 per time unit" in text
    assert "all terms delayed: 0.012783, then a swing at 22.01 rad" in text
    assert "H2 0.041828 time^(3/2)" in text
    assert "mode decay rate (1/time) frequency (rad/time) damping ratio" in text
    assert "breathing 3.0563 21.358 0.1417" in text


def test_a_large_flock_is_not_made_dense(found, monkeypatch):
    from flockana.cli import stability

    whole = found("hexagonal-spiral:30", "--modes", 3)
    monkeypatch.setattr(stability, "DENSE", 10)
    one = found("hexagonal-spiral:30", "--modes", 3)
    assert one["zero modes sought"] == "rigid motions only"
    assert one["zero modes"] == whole["zero modes"]
    assert one["spectral abscissa"] == pytest.approx(whole["spectral abscissa"], rel=1e-7)


def test_a_scenario_is_linearised_where_it_ends(found):
    one = found("hexagon", "--modes", 1)
    assert (one["law"], one["links"]) == ("Algorithm1", 12)
    assert one["spectral abscissa"] == pytest.approx(-1.96374976, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [("hexagonal-patch:1", "--law", 2), ("fcc:1x1x1",), ("line:3", "--law", 2)])
def test_pictures(call, tmp_path, arguments):
    code, out, err = call(*arguments, "--plot", "poles.png")
    assert (code, err) == (0, "")
    assert "picture: poles.png" in out
    assert (tmp_path / "poles.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_a_state_as_given(call, found, tmp_path):
    """Ends pushed together: without --as-given the flock relaxes; with it, the pressed pair is unstable sideways."""
    (tmp_path / "pair.csv").write_text("0,0\n6.5,0\n")
    relaxed, given = found("pair.csv"), found("pair.csv", "--as-given")
    assert relaxed["residual"] < 1e-9 < given["residual"]
    assert relaxed["spectral abscissa"] < 0.0 < given["spectral abscissa"]
    assert "pair.csv: unstable" in " ".join(call("pair.csv", "--as-given")[1].split())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("hexagon", "--law", 1), "hexagon has a law of its own"),
        (("zone-51",), "ZoneFlocking"),
        (("hexagonal-patch:1", "--law", 3), "--law"),
        (("line:200000",), "n = 200000: expected at most 30000 agents, or 150000 with --as-given"),
        (("line:200000", "--as-given"), "n = 200000: expected at most 150000 agents"),
    ],
)
def test_bad_input_is_one_line(refused, arguments, said):
    refused(said, *arguments)


def test_a_law_without_a_potential_is_linearised_about_a_state_of_rest(found, call):
    """A tree of eight in the plane: λ² + λ + μ = 0 for each edge's length, a slower λ = −1 for its direction."""
    one = found("zone-tree", "--modes", 14)
    assert (one["law"], one["n"]) == ("MinimalFlocking", 8)
    assert one["zero modes"][:3] == ["translation x", "translation y", "rotation"]
    assert len(one["zero modes"]) == 2 + 7
    lengths = [mode for mode in one["modes"] if abs(mode["eigenvalue"][1]) > 1e-3]
    assert len(lengths) == 7
    for mode in lengths:
        assert mode["eigenvalue"] == pytest.approx([-0.5, sqrt(0.75)], rel=1e-4)
    code, _, err = call("zone-51-printed")
    assert (code, err.count("\n")) == (2, 1)
    assert "the state is no steady motion of ZoneFlocking" in err


@pytest.mark.parametrize("wrap", [lambda law: Delayed(law, 0.01), lambda law: Sampled(Delayed(law, 0.01), 0.02)])
def test_a_law_with_a_past_or_a_clock(found, call, tmp_path, wrap):
    """One agent at its target, c1γ = 4 and c2γ = 3: the margin is the closed form's, the map's multiplier below 1."""
    law = wrap(Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=3.0), target=StaticTarget((0.0,))))
    simulate(law, [[0.01]], [[0.0]], (0.0, 0.1), dt=0.01).save(tmp_path / "late.nc")
    late = isinstance(law, Delayed)
    one = found("late.nc", *["--delay"] * late, "--modes", 2)
    assert (one["law"], one["n"], one["stable"]) == (type(law).__name__, 1, True)
    if late:
        assert one["delay margin"]["delay"] == pytest.approx(scalar_margin(4.0, 3.0).delay, rel=1e-9)
        assert one["rightmost roots"][0] == pytest.approx([linearise(law, [[0.0]]).rightmost(1)[0].real, 1.2], rel=0.2)
    else:
        assert (one["dt"], one["zero modes"]) == (0.02, [])
        assert 0.9 < one["spectral radius"] < 1.0
    code, out, err = call("late.nc")
    assert (code, err) == (0, "")
    assert "late.nc: stable off its zero modes" in out
    assert call("late.nc", "--plot", "late.png")[0] == 2
    assert f"--norms: a {'Delay' if late else 'Map'}Linearisation of" in call("late.nc", "--norms")[2]


OWN = """import flockana as fl
net = fl.NetConsensus([[0, 0, 0], [1, 0, 0], [0, 1, 0]], velocity=3.0)
ring = fl.Flock(fl.AverageConsensus([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), [[0.0], [1.0], [2.0]])
bent = fl.compose(pair=fl.pair_law("(s-2)**2/2 + Abs(s-2)*(s-2)/5", range=6, length=2, adjacency="(1-s/r)**2"))
"""


@pytest.mark.filterwarnings("ignore:pair_law")
def test_what_a_file_defines_is_linearised(found, call, tmp_path):
    """A chain: λ² + 3λ + 1 twice, whatever its positions; a ring of three: 0 and −3/2 ± j √¾, stable up to 2·0.6046."""
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "three.csv").write_text("0\n1\n5\n")
    net = found("own.py:net", "--at", "three.csv")
    assert [mode["decay rate"] for mode in net["modes"]] == pytest.approx(
        [1.5 - sqrt(1.25)] * 2 + [1.5 + sqrt(1.25)] * 2
    )
    assert net["zero modes"] == ["translation x"]
    ring = found("own.py:ring", "--delay")
    assert (ring["law"], ring["zero modes"], ring["stable"]) == ("AverageConsensus", 1, True)
    assert ring["poles"][1:] == [pytest.approx([-1.5, -sqrt(0.75)]), pytest.approx([-1.5, sqrt(0.75)])]
    assert ring["delay margin"]["delay"] == pytest.approx(0.604599788)  # (π/2 − π/6)/√3
    assert call("own.py:ring")[1].startswith("own.py:ring: stable")  # no picture in place of a name between colons


@pytest.mark.filterwarnings("ignore:pair_law")
def test_refusals_name_options_of_the_command(refused, call, tmp_path):
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "pair.csv").write_text("0,0\n2,0\n")
    refused("own.py:net is NetConsensus", "own.py:net")
    refused("--at pair.csv: hexagon has positions of its own", "hexagon", "--at", "pair.csv")
    refused("--side inner or --side outer takes the law", "own.py:bent", "--at", "pair.csv")
    assert call("own.py:bent", "--at", "pair.csv", "--side", "outer")[0] == 0
    assert str(_with_flags(ArgumentError("no rest: ask for allow_residual=True"))) == "no rest: ask for --as-given"


def test_any_law_has_delay_margins_and_norms(found):
    """The tree of eight again: along each edge s² + (s + 1) e^(−sτ), across s² + s e^(−sτ)."""
    one = found("zone-tree", "--delay")
    best = min(scalar_margin(1.0, 1.0).delay, scalar_margin(0.0, 1.0).delay)
    for kind in ("all", "pairs"):
        assert one[f"delay margin, {kind}"]["delay"] == pytest.approx(best, rel=1e-4)
