import numpy as np
import pytest

from flockana.plots.decay import linear_range
from flockana.plots.style import subplots
from flockana.report import stability
from flockana.report.control_figures import Download
from flockana.report.figures import Picture
from flockana.report.page_data import Finding, FixedPage
from flockana.report.report_writer import write_report
from flockana.report.stability import NO_FLOCKS, LinearisedFlocks, stability_section
from flockana.theorems import Claim, Verdict


def page(theorem, *claims):
    return FixedPage(Finding(Verdict(theorem, (), claims), "a title", "a statement", "a source"))


ROW = {
    "law": "Algorithm1",
    "n": 7,
    "m": 2,
    "mode": "breathing",
    "frequency": 21.04250479,
    "predicted": 2.0,
    "measured": 2.0004,
    "error": 0.003,
    "random, linear": 2.1,
    "random, measured": 2.2,
}


@pytest.fixture
def pages(monkeypatch):
    monkeypatch.setattr(stability, "_flocks", list)
    monkeypatch.setattr(stability, "control_pictures", tuple)
    sizes = np.geomspace(1e-3, 0.1, 5)
    one = {
        "exponent": 1.998,
        "amplitudes": sizes,
        "deviations": 3.0 * sizes,
        "net changes": sizes > 0.05,
        "margin": 0.2,
    }
    return [
        page(
            "linearised-decay",
            Claim("decay", "verified", computed={"hexagon 7, Algorithm 1": ROW}),
            Claim("range", "verified", computed={"hexagon 19": one}, witness={"σ₁ bends at": 0.05}),
        ),
        page("delay-margin", Claim("a", "verified", detail="stable up to τ* = 0.0128")),
        page("heterogeneous-gains", Claim("b", "verified", detail="21 % faster")),
    ]


def test_the_section_shows_what_the_verdicts_hold(pages, tmp_path):
    section = stability_section(pages)
    (row,) = section.rows
    assert (row.name, row.n, row.mode, row.frequency) == ("hexagon 7, Algorithm 1", "7", "breathing", "21.043")
    assert (row.predicted, row.measured, row.error, row.difference) == ("2.00000", "2.00040", "3e-03", "2e-04")
    assert (row.random_linear, row.random_measured, row.status) == ("2.10000", "2.20000", "verified")
    assert [one.caption.split(":")[0] for one in section.pictures] == ["How far the linearisation holds"]
    assert "exponents 1.998" in section.pictures[0].caption
    assert section.margins[:2] == ("stable up to τ* = 0.0128", "21 % faster")
    assert "18 %" in section.margins[2]
    text = write_report(pages, tmp_path).read_text(encoding="utf-8")
    assert 'id="linearised-stability"' in text
    assert 'href="#linearised-stability"' in text
    assert "2.00040" in text


def test_flocks_are_those_given_and_are_never_made_with_the_page(pages, tmp_path, monkeypatch):
    monkeypatch.setattr(stability, "linearised_flocks", None)  # a call would raise
    assert stability_section(pages).flocks is NO_FLOCKS
    given = LinearisedFlocks(
        (Picture("Poles of 19", "<svg></svg>"),), (), (Download("19.json", "19 agents", "data:,1"),)
    )
    assert stability_section(pages, given).flocks is given
    text = write_report(pages, tmp_path, flocks=given).read_text(encoding="utf-8")
    assert "Poles of 19" in text
    assert '<a download="19.json" href="data:,1">19 agents</a>' in text


def test_a_last_state_is_named_for_its_run(pages):
    claim = Claim("decay", "refuted", computed={"n = 7, last state": ROW})
    section = stability_section([page("linearised-decay-terminal", claim)])
    assert [(row.name, row.status) for row in section.rows] == [("linearised-decay-terminal, last state", "refuted")]
    assert section.pictures == section.margins == ()
    empty = stability_section([page("linearised-decay-terminal", Claim("decay", "vacuous"))])
    assert empty.rows == ()


def test_measured_points_stand_on_the_bode_plot(pages, monkeypatch):
    """The MSN project's circle: 3.49 rad/s, measured ratio 0.852, with ω_n = √70 and ζ = 1."""
    claims = (Claim("predicted", "verified", computed=0.8518, stated=0.8518),)
    claims += (Claim("consistent", "verified", computed=1.1093, stated=1.1093),)
    drawn = {}
    monkeypatch.setattr("flockana.plots.measured_gains", lambda points, ax: drawn.update(points))
    picture = stability.bode_picture([("msn-case4", Verdict("E12", (), claims))])
    omega = 2.0 * np.pi * 0.025 / 0.045
    assert drawn["msn-case4, p_r as handed over"] == (pytest.approx(omega), 0.8518)
    assert drawn["msn-case4, p_r true"] == (pytest.approx(omega), 1.1093)
    assert "ω_n = 8.367, ζ = 1" in picture.caption
    verdict = Verdict("E12", (), claims)
    assert stability.bode_picture([("msn-case1", verdict), ("none", verdict)]) is None


def test_the_flocks_are_drawn():
    pictures = stability.flock_pictures(stability._flocks())
    assert "Algorithm 1. Zero modes, not counted: translation x, translation y, rotation" in pictures[0].caption
    assert "abscissa -1.0488, of the shape -1.9352" in pictures[1].caption
    assert all(one.source.startswith("<svg") for one in pictures)


def test_a_linear_range_on_its_axes():
    _, ax = subplots()
    sizes = np.array([1e-3, 1e-2, 1e-1])
    linear_range({"a": (sizes, 2.0 * sizes, [False, False, True])}, marks={"bend": 0.05}, ax=ax)
    curve, intact, broken, guide = ax.lines[:4]
    np.testing.assert_allclose(curve.get_ydata(), guide.get_ydata())
    assert (len(intact.get_xdata()), broken.get_xdata().tolist()) == (2, [0.1])
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
