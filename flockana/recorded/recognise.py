"""Recognition of a recording's law among several: a ranked table of comparisons."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from flockana.base.errors import ArgumentError, FlockanaError, format_value
from flockana.base.short_repr import ShortRepr
from flockana.laws.usual_laws import candidates
from flockana.recorded.compare import Comparison, compare, share_text
from flockana.recorded.recording import Recording, ensure_recording

_FITS = 0.99  # share explained, the gains as the recording has them, from which a law fits


@dataclass(frozen=True, eq=False)
class Recognition(ShortRepr):
    """Laws ranked by their explained share of a recording, and the inapplicable laws.

    Attributes
    ----------
    ranked : tuple of (str, Comparison)
        The laws by name.
    refused : mapping of str to str
        Why a law was not compared.
    """

    ranked: tuple[tuple[str, Comparison], ...]
    refused: Mapping[str, str]

    @property
    def best(self) -> Comparison | None:
        """Comparison with the best-fitting law; None without one."""
        first_fit = self.ranked[0][1] if self.ranked else None
        return first_fit if first_fit is not None and first_fit.explained_refitted >= _FITS else None

    def __str__(self) -> str:
        lines = [
            f"{share_text(item.explained_refitted):>9} ({share_text(item.explained)} with its own gains)  {name}"
            for name, item in self.ranked
        ]
        lines += [f"        -  {name}: {reason}" for name, reason in self.refused.items()]
        if self.best is None:
            lines.append(f"none fits: a law does that explains {_FITS:.0%} with gains as the recording has them")
        return "\n".join(lines)


def recognise(rec: Recording, laws: Mapping[str, Any] | None = None) -> Recognition:
    """Return laws ranked by their explained share of a recording.

    Parameters
    ----------
    rec : Recording
        The recording.
    laws : mapping of str to Law, optional
        The laws by name; by default those that need no target, with their usual parameters.

    Raises
    ------
    ArgumentError
        If there is no law to compare.

    Examples
    --------
    >>> from flockana import Algorithm1, simulate
    >>> from flockana.recorded.recording import recording_of
    >>> run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> recognise(recording_of(run)).ranked[0][0]
    'Algorithm 1'
    """
    ensure_recording(rec)
    if laws is None:
        laws = {name: candidate.law() for name, candidate in candidates().items()}
    if not isinstance(laws, Mapping) or not laws:
        raise ArgumentError(f"laws = {format_value(laws)}: expected laws by name, such as {{'mine': Algorithm1()}}")
    ranking: list[tuple[str, Comparison]] = []
    refusal_reasons: dict[str, str] = {}
    for name, law in laws.items():
        try:
            ranking.append((name, compare(rec, law)))
        except FlockanaError as error:
            refusal_reasons[name] = str(error)
    if not ranking:
        raise ArgumentError(f"no law applies to this recording: {next(iter(refusal_reasons.values()))}")
    return Recognition(tuple(sorted(ranking, key=lambda each: -each[1].explained_refitted)), refusal_reasons)
