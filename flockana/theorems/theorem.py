"""Theorems, hypotheses, claims and verdicts, and how a verdict follows from its claims."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any, Literal

from flockana.base.checks import ensure_nonnegative, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.theorems.written import verdict_html, verdict_latex

Status = Literal["verified", "refuted", "vacuous", "inconclusive"]
Rigour = Literal["symbolic", "smt", "interval", "numeric"]
HypothesisStatus = Literal["met", "unmet", "assumed"]
About = Literal["run", "limit", "all"]
Kind = Literal["trajectory", "configuration", "fixed"]

_RIGOURS: tuple[Rigour, ...] = ("numeric", "interval", "smt", "symbolic")  # weakest first


@dataclass(frozen=True)
class Tolerances:
    """Every threshold that a verdict uses; it is shown with the verdict.

    Parameters
    ----------
    energy : float
        Largest energy-balance residual, relative to the largest |H| of the run, that still counts as the identity.
    velocity : float
        Velocity mismatch K̃ below which velocities count as matched, relative to the square of the law's speed scale.
    force : float
        Largest force on an agent in the moving frame, relative to the law's force scale, below which a state counts as
        an equilibrium.
    lattice : float
        Largest |link − d|/d of what is called an α-lattice; measured, so not exact.
    quasi : float
        Largest |link − d|/d of what is called a quasi-α-lattice (δ ≪ d).
    curvature : float
        Smallest Hessian eigenvalue, relative to the largest, that counts as positive.
    contact : float
        Distance, relative to d, at which two agents count as coincident.
    giant : float
        Share of the agents that a giant component holds at least.
    cohesion : float
        Growth of the cohesion radius over the window, as a factor, that still counts as cohesive.
    deviation : float
        ε₁ of α-flocking: Ẽ ≤ ε₁.
    mismatch : float
        ε₂ of α-flocking: K̃ ≤ ε₂, relative to the square of the law's speed scale.
    settle : float
        Share of the run that is left out as transient before α-flocking is judged.
    agreement : float
        Relative difference at which a measured figure agrees with a predicted or a reported one.

    Lengths, times and forces are relative to `Trajectory.scales`, so that a verdict is the same in all units.

    Raises
    ------
    ArgumentError
        If one is no finite number > 0 (`settle` may be 0), or a share (`giant`, `settle`) is not below 1.

    Examples
    --------
    >>> Tolerances(quasi=0.1).quasi
    0.1
    """

    energy: float = 1e-6
    velocity: float = 1e-10
    force: float = 1e-6
    lattice: float = 1e-6
    quasi: float = 0.1
    curvature: float = 1e-6
    contact: float = 1e-9
    giant: float = 0.5
    cohesion: float = 1.5
    deviation: float = 0.05
    mismatch: float = 1e-4
    settle: float = 0.5
    agreement: float = 0.02

    def __post_init__(self) -> None:
        for field_ in fields(self):
            ensure = ensure_nonnegative if field_.name == "settle" else ensure_positive
            value = ensure(f"tolerances.{field_.name}", getattr(self, field_.name))
            if field_.name in ("giant", "settle") and value >= 1.0:
                raise ArgumentError(f"tolerances.{field_.name} = {value:g}: expected a share below 1")
            object.__setattr__(self, field_.name, value)


@dataclass(frozen=True)
class Hypothesis:
    """A condition of a theorem, and whether it holds in one case.

    Parameters
    ----------
    name : str
        The condition.
    status : {"met", "unmet", "assumed"}
        ``"assumed"`` where it quantifies over more than one run can show.
    margin : float, optional
        How far it is met (positive) or missed (negative).
    detail : str
        In words.
    error : float, optional
        Numerical error of the margin, where it has one.
    """

    name: str
    status: HypothesisStatus
    margin: float | None = None
    detail: str = ""
    error: float | None = None


@dataclass(frozen=True)
class Claim:
    """One statement of a theorem about one case, with its status, margin and numerical error.

    Parameters
    ----------
    name : str
        Short name, such as ``"iii"``.
    status : {"verified", "refuted", "vacuous", "inconclusive"}
        Whether it holds.
    rigour : {"symbolic", "smt", "interval", "numeric"}
        How it is known.
    computed, stated : object
        What was computed here, and what the theorem states.
    margin : float, optional
        How far the claim holds (positive) or fails (negative).
    error : float, optional
        How far the margin may be off towards 0 and beyond; a margin of a smaller size is inconclusive.
    witness : object
        What shows it: a time, a pair of agents, an eigenvalue, an expression.
    proof, disproof : str, optional
        Identifier of an executable proof of exactly this claim, or of its negation, under its needs.
    detail : str
        The statement and the evidence, in one sentence.
    needs : tuple of Hypothesis
        Hypotheses under which it is claimed.
    about : {"run", "limit", "all"}
        What it speaks of: this run, a limit t → ∞, or all cases at once.
    cites : tuple of str
        Lemmas of analysis that the deciding proof takes from the literature.
    contradicts : str
        Identifier of the proof that the decided numbers contradict; the run or the library is at fault then.

    Raises
    ------
    ArgumentError
        On an error below 0, and on a status that the needs do not allow: decided under an unmet one; refuted, or
        verified of a limit or of all cases, under one that is only assumed.
    """

    name: str
    status: Status
    rigour: Rigour = "numeric"
    computed: Any = None
    stated: Any = None
    margin: float | None = None
    error: float | None = None
    witness: Any = None
    proof: str | None = None
    detail: str = ""
    disproof: str | None = None
    needs: tuple[Hypothesis, ...] = ()
    about: About = "run"
    contradicts: str = ""
    cites: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.error is not None and self.error < 0.0:
            raise ArgumentError(f"claim {self.name!r} has error = {self.error:g}: expected none below 0")
        if self.status not in ("verified", "refuted"):
            return
        weak = self.status == "refuted" or self.about != "run"
        barred = {"unmet", "assumed"} if weak else {"unmet"}
        if (need := next((need for need in self.needs if need.status in barred), None)) is not None:
            raise ArgumentError(
                f"claim {self.name!r} is {self.status} though {need.name!r} is {need.status}: expected vacuous or "
                "inconclusive"
            )

    @property
    def cited(self) -> str:
        """What its proof takes from the literature, in words, or an empty text."""
        return f" [proof cites {', '.join(self.cites)}]" if self.cites else ""


@dataclass(frozen=True)
class Verdict:
    """The outcome of checking a theorem on a case.

    Parameters
    ----------
    theorem : str
        Its id.
    hypotheses, claims : tuple
        In the theorem's order.
    tolerances : Tolerances
        Thresholds that were used.
    subject : str
        What it was checked on.
    """

    theorem: str
    hypotheses: tuple[Hypothesis, ...]
    claims: tuple[Claim, ...]
    tolerances: Tolerances = field(default_factory=Tolerances)
    subject: str = ""

    @property
    def status(self) -> Status:
        """Refuted if a claim is; else inconclusive if one is; else verified if one is; else vacuous."""
        return overall([claim.status for claim in self.claims])

    @property
    def contradictions(self) -> tuple[Claim, ...]:
        """Claims whose decided numbers contradict a proof."""
        return tuple(claim for claim in self.claims if claim.contradicts)

    @property
    def rigour(self) -> Rigour:
        """The weakest rigour among the claims that decide the status."""
        deciding = [c.rigour for c in self.claims if c.status == self.status] or ["numeric"]
        return min(deciding, key=_RIGOURS.index)

    def claim(self, name: str) -> Claim:
        """The claim of that name.

        Parameters
        ----------
        name : str
            Such as ``"iii"``.

        Raises
        ------
        KeyError
            If there is none.
        """
        for claim in self.claims:
            if claim.name == name:
                return claim
        raise KeyError(f"{self.theorem} has no claim {name!r}; it has {', '.join(c.name for c in self.claims)}")

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON; infinities and NaN become text."""
        data: dict[str, Any] = _plain(asdict(self))
        for claim in data["claims"]:
            claim["needs"] = [need["name"] for need in claim["needs"]]
        return {"theorem": data.pop("theorem"), "status": self.status, "rigour": self.rigour} | data

    def __str__(self) -> str:
        lines = [f"{self.theorem}: {self.status} ({self.rigour}){' on ' + self.subject if self.subject else ''}"]
        lines += [f"  given {h.status:8} {h.name}{': ' + h.detail if h.detail else ''}" for h in self.hypotheses]
        lines += [f"  {c.name:>14} {c.status:12} {c.detail}{c.cited}" for c in self.claims]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        return verdict_html(self)

    def to_latex(self) -> str:
        """Return the claims as a LaTeX ``tabular`` in the style of booktabs."""
        return verdict_latex(self)


Lead = Callable[[Any, Claim], float]
Checked = tuple[list[Hypothesis], list[Claim]]  # what a theorem's `check` returns


@dataclass(frozen=True)
class Theorem:
    """A published statement, or its correction, with the function that checks it.

    Parameters
    ----------
    id : str
        Such as ``"os-1"``.
    title : str
        One line.
    statement : str
        What it says, in our words.
    source : str
        Where it is printed.
    kind : {"trajectory", "configuration", "fixed"}
        What `check` takes before the tolerances: a Trajectory; q, d, r; or nothing.
    check : callable
        Returns (hypotheses, claims); claims may be left out where a hypothesis is unmet (see `claims`).
    references : tuple of str
        Keys of the bibliography.
    expected : mapping of str to str
        For a fixed theorem, the status that is expected of it (key = its id) and of its claims (key = ``"id:claim"``).
    leads : mapping of str to callable
        By claim, a surrogate ``lead(trajectory, claim)`` in [0, 1] that leads a search for a counterexample where the
        claim's margin gives no slope.
    law : callable, optional
        Of a theorem about runs: ``law(run)`` is the hypothesis that the run is of a law that the theorem is about. Only
        if it is met is `check` called.
    claims : tuple of str
        Names of the claims, in order. Those that `check` leaves out are vacuous if a hypothesis is unmet.
    reason : str
        Text of such a vacuous claim, with ``{name}`` and ``{detail}`` of the first unmet hypothesis.
    enclosed : callable, optional
        As `check`, of a tube (`flockana.enclose`), a certified basin that it may end in or None, and the tolerances.
    """

    id: str
    title: str
    statement: str
    source: str
    kind: Kind
    check: Callable[..., tuple[Iterable[Hypothesis], Iterable[Claim]]]
    references: tuple[str, ...] = ("olfati-saber-2006",)
    expected: Mapping[str, Status] = field(default_factory=dict)
    leads: Mapping[str, Lead] = field(default_factory=dict)
    law: Callable[[Any], Hypothesis] | None = None
    claims: tuple[str, ...] = ()
    reason: str = "{name}: {detail}"
    enclosed: Callable[..., tuple[Iterable[Hypothesis], Iterable[Claim]]] | None = None

    def examine(
        self, *case: Any, check: Callable[..., tuple[Iterable[Hypothesis], Iterable[Claim]]] | None = None
    ) -> tuple[tuple[Hypothesis, ...], tuple[Claim, ...]]:
        """Hypotheses and claims of one case; claims that `check` leaves out for an unmet hypothesis are vacuous.

        Parameters
        ----------
        *case : object
            What `check` takes, the tolerances last.
        check : callable, optional
            Another check than the theorem's own, such as `enclosed`.
        """
        hypotheses = [] if self.law is None else [self.law(case[0])]
        claims: list[Claim] = []
        if unmet(hypotheses) is None:
            further, stated = (check or self.check)(*case)
            hypotheses, claims = [*hypotheses, *further], list(stated)
        if (missed := unmet(hypotheses)) is not None:
            text, made = self.reason.format(name=missed.name, detail=missed.detail), {claim.name for claim in claims}
            claims += [Claim(name, "vacuous", detail=text) for name in self.claims if name not in made]
        return tuple(hypotheses), tuple(claims)


def unmet(hypotheses: Iterable[Hypothesis]) -> Hypothesis | None:
    """The first hypothesis that is not met, if any is not.

    Parameters
    ----------
    hypotheses : iterable of Hypothesis
        In the theorem's order.

    Examples
    --------
    >>> unmet([Hypothesis("c1α > 0", "met"), Hypothesis("c2α > 0", "unmet")]).name
    'c2α > 0'
    """
    return next((hypothesis for hypothesis in hypotheses if hypothesis.status == "unmet"), None)


def overall(statuses: Iterable[Status]) -> Status:
    """Status of a theorem from those of its claims: refuted if one is, else inconclusive, verified, vacuous.

    Parameters
    ----------
    statuses : iterable of str
        Of the claims.

    Examples
    --------
    >>> overall(["verified", "refuted"]), overall(["vacuous", "verified"]), overall([])
    ('refuted', 'verified', 'vacuous')
    """
    given = set(statuses)
    order: tuple[Status, ...] = ("refuted", "inconclusive", "verified")
    return next((status for status in order if status in given), "vacuous")


def _plain(value: Any) -> Any:
    import numpy as np

    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)
