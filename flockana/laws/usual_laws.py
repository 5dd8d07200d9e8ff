"""Laws without a target, with usual parameters, for trial on a flock or comparison with a recording."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from flockana.base.module_discovery import source_modules
from flockana.laws.law import Law
from flockana.laws.olfati_saber import Algorithm1


@dataclass(frozen=True)
class Candidate:
    """Law without a target to be tried on a flock, with the distance of neighbours and the duration of a trial."""

    law: type[Law]
    length: float = 7.0  # distance of neighbours
    span: float = 10.0  # time to run


@cache
def candidates() -> Mapping[str, Candidate]:
    """Return the candidate laws by name: Algorithm 1, and the `CANDIDATES` of the sources' laws."""
    named_candidates = {"Algorithm 1": Candidate(Algorithm1, span=20.0)}
    for module in source_modules("laws"):
        named_candidates |= getattr(module, "CANDIDATES", {})
    return named_candidates
