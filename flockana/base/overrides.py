"""Whether what a class says of its methods still holds of a subclass that changed them."""

from __future__ import annotations

from collections.abc import Iterable


def speaks_for(kind: type, name: str, others: Iterable[str]) -> bool:
    """Whether no subclass of the class that defines an attribute, as far as `kind`, defines any of the others anew.

    Examples
    --------
    >>> class Square:
    ...     side = 2.0
    ...     area = 4.0
    >>> class Larger(Square):
    ...     side = 3.0
    >>> speaks_for(Square, "area", ["side"]), speaks_for(Larger, "area", ["side"])
    (True, False)
    """
    ways = list(kind.__mro__)
    defined = next(k for k, base in enumerate(ways) if name in vars(base))
    return not any(other in vars(base) for base in ways[:defined] for other in others)
