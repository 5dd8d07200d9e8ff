import pytest

from flockana.lattice import harborth
from flockana.report.lattices import lattice_section
from flockana.report.page_data import Finding, FixedPage
from flockana.report.report_writer import write_report
from flockana.theorems import Claim, Hypothesis, Verdict


def page(theorem, *claims, hypotheses=()):
    return FixedPage(Finding(Verdict(theorem, hypotheses, claims), "a title", "a statement", "a source"))


@pytest.fixture
def pages():
    lattice = Hypothesis("q is an α-lattice", "unmet", detail="quasi-α-lattice: δ/d = 0.03")
    end = page(
        "os-5-terminal",
        Claim("i", "vacuous", computed=2),
        Claim("ii-sharp", "vacuous", computed=41),
        Claim("extension", "verified", computed=2),
        hypotheses=(lattice,),
    )
    without = page("os-5-terminal", *(Claim(name, "vacuous") for name in ("i", "ii-sharp", "extension")))
    collapse = page("E11", Claim("threshold", "verified", computed={7: [3.8, 3.9], 19: [1.1, 1.2]}))
    values = {3: {"together": 50.0, "ground": 0.0}, 7: {"together": 55.0, "ground": 6.0}}
    barrier = page(
        "E4", Claim("found", "verified", witness={"c*": 50.0}), Claim("barrier", "verified", computed=values)
    )
    return [end, without, collapse, barrier]


def test_the_section_shows_what_the_verdicts_hold(pages, tmp_path):
    section = lattice_section(pages)
    assert len(section.ends) == 1  # a law without a range has no net
    end = section.ends[0]
    assert (end.kind, end.links, end.crossings) == ("quasi-α-lattice: δ/d = 0.03", "41", "2")
    assert (end.printed, end.extension) == ("vacuous", "verified")
    assert [n for n, _, _ in section.spirals] == list(range(3, 21))
    assert all(count == most == harborth(n) for n, count, most in section.spirals)
    assert ["E11" in one.caption for one in section.pictures] == [True, False]
    text = write_report(pages, tmp_path).read_text(encoding="utf-8")
    assert 'id="lattices-and-equilibria"' in text
    assert 'href="#lattices-and-equilibria"' in text
    assert text.count('class="drawn"') == 2


def test_without_their_verdicts_there_are_no_pictures_and_no_section(pages, tmp_path):
    vacuous = page("E11", Claim("threshold", "vacuous"))
    assert lattice_section([vacuous]).pictures == ()
    other = page("E8", Claim("threshold", "verified", computed={7: [1.0, 2.0]}))
    assert lattice_section([other]) is None
    assert "lattices-and-equilibria" not in write_report([other], tmp_path).read_text(encoding="utf-8")
