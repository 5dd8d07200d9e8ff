import pytest

from flockana.base.errors import UnknownNameError
from flockana.report.coverage import Reference, Row, Source
from tools.coverage_references import faults, locate


@pytest.mark.parametrize(
    ("kind", "name", "file"),
    [
        ("function", "flockana.Algorithm2", "flockana/laws/olfati_saber.py"),
        ("function", "flockana.AlphaInteraction.kappa", "flockana/interactions/alpha.py"),  # a property
        ("function", "flockana.Algorithm1.surfaces", "flockana/laws/law.py"),  # an inherited property
        ("function", "flockana.measures.reynolds.Reynolds.stress", "flockana/measures/reynolds.py"),  # a field
        ("function", "flockana.falsify", "flockana/falsify/campaign.py"),  # a function and a folder
        (
            "function",
            "flockana.sources.notebook_r2.laws.MIN_DISTANCE",
            "flockana/sources/notebook_r2/laws.py",
        ),  # a number
        ("plot", "flockana.plots.action", "flockana/plots/pair.py"),
        ("scenario", "msn-case1-printed", "flockana/sources/isola_2024/scenarios/cases.py"),
        ("theorem", "os-5-terminal", "flockana/sources/olfati_saber_2006/theorems/theorem_5_planar_nets.py"),
        ("erratum", "L10", "flockana/sources/li_dead_zone/theorems/l10_necessary_conditions.py"),
        ("claim", "os-3/iv-barrier", "flockana/sources/olfati_saber_2006/theorems/theorem_3_led_flock.py"),
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
        ("function", "flockana.laws.algorithm4", "flockana.laws.algorithm3"),
        ("function", "numpy.zeros", "flockana."),
        ("plot", "flockana.plots.actions", "flockana.plots.action"),
        ("scenario", "paper-floking", "paper-flocking"),
        ("report", "msn-case1/fragment", "msn-case1/fragments"),
        ("theorem", "os-2", "did you mean 'os-"),
        ("theorem", "E4", "nearest of"),  # is an erratum
        ("erratum", "E0", "E10"),
        ("claim", "os-3/iv-barier", "os-3/iv-barrier"),
        ("proof", "sign_of_phi", "signs_of_phi"),
        ("notebook", "99", "09"),
    ],
)
def test_a_wrong_name_is_told_with_those_near_it(kind, name, nearest):
    with pytest.raises(UnknownNameError, match=f"unknown {kind} '{name}'") as raised:
        locate(Reference(kind, name))
    assert nearest in str(raised.value)


def test_a_wrong_name_is_told_with_its_source_and_place():
    wrong = Row("Fig. 3", "a run", "held", (Reference("scenario", "colapse"), Reference("theorem", "os-3")))
    (fault,) = faults([Source("jond-2025", "A paper", (wrong,))])
    assert fault.startswith("jond-2025, Fig. 3: unknown scenario 'colapse'; did you mean 'collapse'?")
