"""Report section on lattices and equilibria, built from the verdicts alone."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from scipy.spatial.distance import pdist

from flockana.lattice import harborth, hexagonal_spiral
from flockana.report.figures import Picture, drawn
from flockana.report.page_data import Page
from flockana.report.svg_figures import plots
from flockana.theorems import Verdict

_SIZES = range(3, 21)
_TOPICS = ("os-5-terminal", "E3", "E4", "E5", "E6", "E11")


class EndState(NamedTuple):
    """Description of the net at the end of a run: lattice kind, links, crossings of links, and claim statuses."""

    scenario: str
    kind: str  # α-lattice, quasi-α-lattice or neither, with its strain
    links: str  # links, crossings: Their numbers
    crossings: str
    # printed, extension: Statuses of "no two links cross", as printed of α-lattices, and extended to every net with
    # distances above r/√2
    printed: str
    extension: str


@dataclass(frozen=True)
class LatticeSection:
    """Report section on lattices and equilibria: nets at the end of runs, hexagonal spirals, and pictures."""

    ends: tuple[EndState, ...]  # by scenario
    spirals: tuple[tuple[int, int, int], ...]  # n, links of the hexagonal spiral, Harborth's number
    pictures: tuple[Picture, ...]  # collapse and barrier, where their verdicts are at hand


def lattice_section(pages: Iterable[Page]) -> LatticeSection | None:
    """Return the section on lattices and equilibria from the verdicts; None without any."""
    verdicts = [(page.name, finding.verdict) for page in pages for finding in page.findings]
    verdicts = [(name, verdict) for name, verdict in verdicts if verdict.theorem in _TOPICS]
    if not verdicts:
        return None
    end_states = (end for name, v in verdicts if v.theorem == "os-5-terminal" for end in _end(name, v))
    spirals = tuple((n, int((pdist(hexagonal_spiral(n, 7.0)) < 8.4).sum()), harborth(n)) for n in _SIZES)
    all_verdicts = [verdict for _, verdict in verdicts]
    return LatticeSection(tuple(end_states), spirals, (*_collapse(all_verdicts), *_barrier(all_verdicts)))


def _end(name: str, verdict: Verdict) -> Iterator[EndState]:
    claims = {claim.name: claim for claim in verdict.claims}
    for kind in (h.detail for h in verdict.hypotheses if h.name == "q is an α-lattice"):
        if "ii-sharp" in claims:
            printed_claim, extension, count = claims["i"], claims["extension"], claims["ii-sharp"].computed
            yield EndState(name, kind, str(count), str(printed_claim.computed), printed_claim.status, extension.status)


def _computed(verdicts: Sequence[Verdict], theorem: str, claim: str) -> Any:
    """Return the computed number of a claim in the first verdict on a theorem; None without one."""
    claims = (c for v in verdicts if v.theorem == theorem for c in v.claims if c.name == claim)
    return next((c.computed for c in claims if c.computed is not None), None)


def _collapse(verdicts: Sequence[Verdict]) -> Iterator[Picture]:
    brackets = _computed(verdicts, "E11", "threshold")
    text = (
        "Algorithm 2 on hexagonal patches (E11): up to the lower mark of the ratio of gains all agents stay apart, "
        "from the upper mark on some coincide permanently. Both fall with the number of agents."
    )
    if brackets is not None:
        yield drawn(text, (6.5, 3.4), plots().collapse_brackets, brackets)


def _barrier(verdicts: Sequence[Verdict]) -> Iterator[Picture]:
    computed_value = _computed(verdicts, "E4", "barrier")
    witness = next((c.witness for v in verdicts if v.theorem == "E4" for c in v.claims if c.name == "found"), None)
    text = (
        "The barrier against collisions (E4), found numerically. V < c* excludes collisions, but the least V of all "
        "states rises with n until none is below c*. The barrier is the least V with two agents coincident minus the "
        "least V of all states; it stays near c*."
    )
    if computed_value is not None and witness is not None:
        energies = ({n: energy_of[key] for n, energy_of in computed_value.items()} for key in ("together", "ground"))
        yield drawn(text, (6.5, 3.4), plots().barrier, *energies, witness["c*"])
