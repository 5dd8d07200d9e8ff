"""Laws that need no target, with their usual parameters: to be tried on a flock, or compared with a recording."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from flockana.base.modules import source_modules
from flockana.laws.law import Law
from flockana.laws.olfati_saber import Algorithm1


@dataclass(frozen=True)
class Candidate:
    """Law that needs no target, with the scale of a flock to try it on."""

    law: type[Law]
    length: float = 7.0  # distance of neighbours
    span: float = 10.0  # time to run


@cache
def candidates() -> Mapping[str, Candidate]:
    """Return the candidates by name, for people: Algorithm 1, and those in the `CANDIDATES` of the sources' laws."""
    named = {"Algorithm 1": Candidate(Algorithm1, span=20.0)}
    for module in source_modules("laws"):
        named |= getattr(module, "CANDIDATES", {})
    return named
