"""Counterexamples as JSON files, to be simulated and checked again."""

import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Self

from flockana._version import __version__
from flockana.base.errors import ArgumentError, FileError, FlockanaError
from flockana.base.files import read_text_file, write_atomic
from flockana.base.integrity_seals import ensure_sealed, sealed, with_digest, without_digest
from flockana.base.serialize import from_data, read_json, to_data, to_data_mapping
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray, ensure_state, ensure_time_span
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.falsify.confirmation_run import confirmed
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.laws.law import Law
from flockana.theorems import Theorem, Tolerances, Verdict, theorems, verify

FORMAT = "flockana-counterexample"
FORMAT_VERSION = 1
_OPTIONS = ("method", "rtol", "atol", "dt", "max_step", "t_eval")  # of `simulate`, as a file may give them
_TEXTS, _NUMBERS = ("theorem", "claim", "scenario"), ("margin", "error")
_KEYS = (
    *("format", "format_version", "flockana_version", *_TEXTS, *_NUMBERS),
    *("law", "q0", "p0", "t_span", "options", "tolerances"),
)


@dataclass(frozen=True, eq=False)
class Counterexample(ShortRepr):
    """Counterexample: law, start, and the claim refuted by the run from there.

    Parameters
    ----------
    theorem, claim : str
        The claim that is refuted, and its theorem.
    scenario : str
        Where the search began.
    q0, p0 : ndarray, shape (n, m)
        The start.
    margin, error : float
        Of the claim when it was refuted; NaN if it has none.
    version : str
        Of flockana, when it was written.
    """

    theorem: str
    claim: str
    scenario: str
    law: Law | DiscreteLaw
    q0: FloatArray
    p0: FloatArray
    t_span: tuple[float, float]
    options: Mapping[str, Any] = field(default_factory=dict)
    tolerances: Tolerances = field(default_factory=Tolerances)
    margin: float = math.nan
    error: float = math.nan
    version: str = __version__

    def _ensure_found(self) -> None:
        source = "one as falsify found it or Counterexample.load read it"
        ensure_sealed("counterexample", self, source, "verify(theorem, law=, q0=, p0=, t_span=) judges any other start")

    def run(self) -> Trajectory:
        """Simulate the counterexample.

        Raises
        ------
        KeyboardInterrupt
            If it was interrupted.
        """
        return ensure_uninterrupted(simulate(self.law, self.q0, self.p0, self.t_span, **self.options))

    def verify(self, run: Trajectory, *, theorem: Theorem | None = None) -> Verdict:
        """Check the theorem on a run of the counterexample.

        Parameters
        ----------
        theorem : Theorem, optional
            The theorem itself, if it is not one of the catalogue.
        """
        subject = f"a counterexample from {self.scenario}"
        if self.theorem not in theorems() and getattr(theorem, "id", None) != self.theorem:
            remedy = "give that claim: theorem=..., or `flockana falsify FILE.py:NAME --replay`"
            raise ArgumentError(f"a counterexample to {self.theorem!r}, which is not in the catalogue: {remedy}")
        return verify(theorem or self.theorem, run, tolerances=self.tolerances, subject=subject)

    def check(self, *, theorem: Theorem | None = None) -> Verdict:
        """Simulate the counterexample and check its theorem, confirmed by a run at a thousandth of the tolerance.

        Parameters
        ----------
        theorem : Theorem, optional
            The theorem itself, if it is not one of the catalogue.

        Raises
        ------
        ArgumentError
            If it was changed by hand.
        KeyboardInterrupt
            If it was interrupted.
        """
        self._ensure_found()
        judge = partial(self.verify, theorem=theorem)
        return confirmed(judge(self.run()), judge, self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the counterexample as JSON; numbers read back exactly, an existing file is replaced only when whole.

        Raises
        ------
        FileError
            If it cannot be written.
        ArgumentError
            If it was changed by hand, or the law holds something that has no written form, such as a user's function.
        """
        self._ensure_found()
        data: dict[str, Any] = {"format": FORMAT, "format_version": FORMAT_VERSION, "flockana_version": self.version}
        data |= {name: getattr(self, name) for name in _TEXTS}
        data |= {name: x if math.isfinite(x := getattr(self, name)) else None for name in _NUMBERS}
        data |= {name: to_data(getattr(self, name)) for name in ("law", "q0", "p0", "t_span")}
        data |= {"options": to_data_mapping(self.options), "tolerances": asdict(self.tolerances)}
        return write_atomic(path, json.dumps(with_digest(data), indent=1, ensure_ascii=False, allow_nan=False) + "\n")

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a counterexample that `save` wrote.

        Raises
        ------
        FileError
            If it cannot be read, is not one of ours, is of another format, or is damaged.
        """
        try:
            data = read_json(read_text_file(path))
        except ValueError as error:
            raise FileError(f"{path} is no JSON ({error}): expected a file that `flockana falsify -o` wrote") from error
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            format_ = data.get("format") if isinstance(data, dict) else type(data).__name__
            raise FileError(f"{path} holds no counterexample (format {format_!r}, expected {FORMAT!r})")
        if data.get("format_version") != FORMAT_VERSION:
            raise FileError(
                f"{path} is of format {data.get('format_version')!r}, expected {FORMAT_VERSION}: use the flockana that "
                f"wrote it ({data.get('flockana_version')}), or search again"
            )
        try:
            theorem, claim, scenario, version = (_text(data[name]) for name in (*_TEXTS, "flockana_version"))
            numbers = [math.nan if data[name] is None else float(data[name]) for name in _NUMBERS]
            law, tolerances = ensure_law(from_data(data["law"])), Tolerances(**data["tolerances"])
            state = ensure_state(data["q0"], data["p0"])
            start = *state, ensure_time_span(data["t_span"]), _options(data["options"])
            counterexample = cls(theorem, claim, scenario, law, *start, tolerances, numbers[0], numbers[1], version)
            without_digest(data, keys=_KEYS)
        except (KeyError, TypeError, ValueError, AttributeError, RecursionError, FlockanaError) as error:
            raise FileError(f"{path} is damaged: {error}; search again with `flockana falsify`") from error
        return sealed(counterexample)


def replay(path: str | os.PathLike[str], *, theorem: Theorem | None = None) -> Verdict:
    """Simulate a counterexample from its file and check its theorem anew.

    Parameters
    ----------
    theorem : Theorem, optional
        The theorem itself, if it is not one of the catalogue.

    Returns
    -------
    Verdict
        Whether its claim is refuted again says ``replay(path).claim(name).status``.

    Raises
    ------
    FileError
        If it cannot be read, is not one of ours, is of another format, or is damaged.
    UnknownNameError
        If the catalogue has no such theorem.
    """
    return Counterexample.load(path).check(theorem=theorem)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is no text")
    return value


def _options(data: Any) -> dict[str, Any]:
    """Return the keyword arguments of `simulate` from a counterexample's data; raise on unknown ones."""
    unknown = sorted({*data} - {*_OPTIONS})
    if unknown:
        raise ValueError(f"options {', '.join(unknown)}: expected some of {', '.join(_OPTIONS)}")
    return {key: from_data(value) for key, value in data.items()}
