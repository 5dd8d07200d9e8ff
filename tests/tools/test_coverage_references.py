import pytest

import flockana.laws
from flockana.base.errors import ArgumentError, FileError, UnknownNameError
from flockana.report.coverage import Reference, Row, Source
from tools import coverage_references
from tools.coverage_references import faults, locate


@pytest.mark.parametrize(
    ("kind", "name", "file"),
    [
        ("function", "flockana.Algorithm2", "flockana/laws/olfati_saber.py"),
        ("function", "flockana.AlphaInteraction.kappa", "flockana/interactions/alpha.py"),  # a property
        ("function", "flockana.Algorithm1.terms", "flockana/laws/olfati_saber.py"),  # a cached one
        ("function", "flockana.Algorithm1.surfaces", "flockana/laws/law.py"),  # an inherited property
        ("function", "flockana.measures.reynolds.Reynolds.stress", "flockana/measures/reynolds.py"),  # a field
        ("function", "flockana.kernels.neighbours.pair_list", "flockana/kernels/neighbours.py"),
        ("function", "flockana.falsify", "flockana/falsify/campaign.py"),  # a function and a folder
        ("function", "flockana.laws.notebook.MIN_DISTANCE", "flockana/laws/notebook.py"),  # a number
        ("plot", "flockana.plots.action", "flockana/plots/pair.py"),
        ("scenario", "msn-case1-printed", "flockana/scenarios/msn.py"),
        ("report", "msn-case1/fragments", "flockana/scenarios/msn.py"),
        ("theorem", "os-5-terminal", "flockana/theorems/olfati_saber/os_5.py"),
        ("erratum", "L10", "flockana/theorems/dead_zone/l10.py"),
        ("claim", "os-3/iv-barrier", "flockana/theorems/olfati_saber/os_3.py"),
        ("claim", "J4/28", "flockana/theorems/bearing_distance/j04.py"),
        ("proof", "signs_of_phi", "proofs/signs_of_phi.py"),
        ("notebook", "01", "notebooks/01_pair_potentials.py"),
    ],
)
def test_where_names_lead(kind, name, file):
    assert locate(Reference(kind, name)) == file


@pytest.mark.parametrize(
    ("kind", "name", "nearest"),
    [
        ("function", "flockana.Algorithm4", "flockana.Algorithm"),
        ("function", "flockana.AlphaInteraction.kapa", "flockana.AlphaInteraction.kappa"),
        ("function", "flockana.laws.notebok", "flockana.laws.notebook"),
        ("function", "flockana", "flockana."),
        ("function", "numpy.zeros", "flockana."),
        ("plot", "flockana.plots.actions", "flockana.plots.action"),
        ("scenario", "paper-floking", "paper-flocking"),
        ("report", "msn-case1/fragment", "msn-case1/fragments"),
        ("theorem", "os-2", "did you mean 'os-"),
        ("theorem", "E4", "nearest of"),  # is an erratum
        ("erratum", "E0", "E10"),
        ("erratum", "os-1", "E1"),  # is none
        ("claim", "os-3/iv-barier", "os-3/iv-barrier"),
        ("claim", "os-3", "os-3/iii"),
        ("proof", "sign_of_phi", "signs_of_phi"),
        ("proof", "intervals", "nearest of"),  # a module beside the proofs
        ("notebook", "99", "09"),
    ],
)
def test_a_wrong_name_is_told_with_those_near_it(kind, name, nearest):
    with pytest.raises(UnknownNameError, match=f"unknown {kind} '{name}'") as raised:
        locate(Reference(kind, name))
    assert nearest in str(raised.value)


def test_names_near_a_wrong_one_do_not_hang_on_what_has_been_imported(monkeypatch):
    monkeypatch.delattr(flockana.laws, "notebook", raising=False)  # as if nobody had imported it
    with pytest.raises(UnknownNameError, match=r"did you mean 'flockana\.laws\.notebook'\?"):
        locate(Reference("function", "flockana.laws.notebok"))


def test_a_report_or_claim_of_what_is_none_names_it():
    with pytest.raises(UnknownNameError, match="unknown scenario 'msn-case9'"):
        locate(Reference("report", "msn-case9/fragments"))
    with pytest.raises(UnknownNameError, match="unknown theorem or erratum 'os-9'"):
        locate(Reference("claim", "os-9/i"))


def test_a_plot_is_defined_among_the_plots():
    with pytest.raises(ArgumentError, match=r"plot 'flockana.links' is defined in flockana/measures/nets.py"):
        locate(Reference("plot", "flockana.links"))


@pytest.mark.parametrize(("kind", "name"), [("theory", "os-1"), ("", "os-1"), ("theorem", "")])
def test_a_reference_has_a_kind_and_a_name(kind, name):
    with pytest.raises(ArgumentError, match=f"reference '{kind}:{name}': expected kind:name"):
        Reference(kind, name)


def test_proofs_and_notebooks_stand_in_a_checkout(tmp_path, monkeypatch):
    monkeypatch.setattr(coverage_references, "_CHECKOUT", tmp_path)
    with pytest.raises(FileError, match=r"there is no folder proofs .* expected a checkout"):
        locate(Reference("proof", "signs_of_phi"))


def test_a_wrong_name_is_told_with_its_source_and_place():
    wrong = Row("Fig. 3", "a run", "held", (Reference("scenario", "colapse"), Reference("theorem", "os-3")))
    (fault,) = faults([Source("jond-2025", "A paper", (wrong,))])
    assert fault.startswith("jond-2025, Fig. 3: unknown scenario 'colapse'; did you mean 'collapse'?")
