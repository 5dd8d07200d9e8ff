"""Pair law from a formula: potential and slopes by sympy, compiled like a hand-written law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from flockana.base.errors import ArgumentError
from flockana.base.function_facts import PairFacts
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_positive, normalise
from flockana.interactions.distance_functions import SlopeBound
from flockana.interactions.formula_parts import FormulaParts, formula_parts
from flockana.interactions.pair_interaction import PairInteraction
from flockana.kernels.generated_scalars import generated_kernels

if TYPE_CHECKING:
    from flockana.kernels.pair_kernels import PairKernels
    from flockana.symbolic.derivation import Derivation

_SAME = 1e-9  # relative: a formula without a hidden unit changes with the units to rounding


@dataclass(frozen=True, repr=False)
class FormulaInteraction(PairInteraction):
    """Pair law given by a formula as text, with values of its parameters; `pair_law` also accepts sympy.

    Parameters
    ----------
    potential : str
        ψ as a formula in the distance s, or in the σ-norm z = (√(1 + εs²) − 1)/ε with a parameter ``eps``. Names are
        those of the parameters, r and d (range and length), and beside z also r_z and d_z, their σ-norms.
    force_formula : str
        Instead of the potential its derivative, dψ/ds or dψ/dz: negative repels. ψ is then integrated numerically,
        to 1e-13 of its size, and vanishes at the length.
    adjacency_formula : str
        a_ij, of the same distance; "0" for none.
    r : float
        Range, in the user's length unit: farther pairs do not interact.
    d : float
        Length that it holds neighbours at, or another length of its own, d ≤ r.
    parameters : tuple of (str, float)
        The names in the formula, with their values.
    powers : tuple of (str, int, int)
        Powers of length and time of each parameter, for `flockana.rescale`.

    Raises
    ------
    ArgumentError
        On a formula that cannot be read, a name without a value or a value without a name, and numbers out of range.

    Examples
    --------
    >>> law = FormulaInteraction("k*(s - d)**2*(s - r)**2", d=2.0, r=3.0, parameters=(("k", 0.5),))
    >>> law.faults
    ('coincidence is excluded: the force has no limit where two agents meet',)
    >>> round(law.force(2.2), 12), law.energy([2.0, 2.2, 4.0]).round(12).tolist()
    (-0.096, [0.0, 0.0128, 0.0])
    """

    potential: str = ""
    force_formula: str = ""
    adjacency_formula: str = "0"
    r: float = 1.0
    d: float = 1.0
    parameters: tuple[tuple[str, float], ...] = ()
    powers: tuple[tuple[str, int, int], ...] = ()

    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"kernels": ("force", "adjacency", "energy", "values")}
    names_in_files: ClassVar[Mapping[str, str]] = {"adjacency_formula": "adjacency"}

    def __post_init__(self) -> None:
        if bool(self.potential) == bool(self.force_formula):
            raise ArgumentError("expected a potential or a force, one of the two")
        normalise(self, ensure_positive, "r", "d")
        if self.d > self.r:
            raise ArgumentError(f"length = {self.d:g} and range = {self.r:g}: expected a length within the range")
        pairs = tuple(sorted((str(k), ensure_finite_scalar(f"parameters[{k!r}]", v)) for k, v in self.parameters))
        names = [name for name, _ in pairs]
        if len({*names}) < len(names):
            raise ArgumentError(f"parameters {names}: expected every name once")
        object.__setattr__(self, "parameters", pairs)
        powers = tuple(sorted((str(k), int(a), int(b)) for k, a, b in self.powers))
        unknown = sorted({k for k, _, _ in powers} - {*names})
        if unknown:
            raise ArgumentError(f"units of {unknown[0]!r}: expected a parameter, one of {', '.join(names) or 'none'}")
        object.__setattr__(self, "powers", powers)
        _ = self._parts  # what is wrong with the formula is said here

    @property
    def _parts(self) -> FormulaParts:
        main = self.force_formula or self.potential
        return formula_parts(main, bool(self.force_formula), self.adjacency_formula, self.r, self.d, self.parameters)

    @property
    def kernels(self) -> PairKernels:  # type: ignore[override]  # compiled when first asked for
        """Compiled sums over pairs, shared by all laws of this formula."""
        return generated_kernels(*self._parts.texts)

    @property
    def range(self) -> float:
        """The interaction range r."""
        return self.r

    @property
    def length(self) -> float:
        """Desired distance d of neighbours."""
        return self.d

    @property
    def lattice(self) -> tuple[float, float] | None:
        """(d, r) if the force repels below d and attracts above; else None."""
        return (self.d, self.r) if self._parts.holds else None

    @property
    def surfaces(self) -> tuple[float, ...]:
        """Distances at which the force jumps, and the range."""
        return self._parts.surfaces

    @property
    def seams(self) -> tuple[float, ...]:
        """Distances at which pieces of the formula meet, and the range."""
        return self._parts.seams

    @property
    def facts(self) -> PairFacts:
        """Facts proved of the formula over its whole range by branch and bound, computed at first use."""
        return self._parts.facts

    @property
    def faults(self) -> tuple[str, ...]:
        """Points where the law is not C¹, does not end smoothly or has no limit, each in words."""
        coincidence_text = "coincidence is excluded: the force has no limit where two agents meet"
        return (*(() if self.coincidence else (coincidence_text,)), *self.facts.faults)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks for the user: further sign changes of the force, infinite force, jumps at the range.

        The signs are those at 255 distances; `facts.zeros` has the places between them.

        Examples
        --------
        >>> for remark in FormulaInteraction("(s**2 - 1)*(s**2 - 4)**2", r=2.5, d=1.0).remarks:
        ...     print(remark)
        two agents rest at s = 2, not at length = 1
        the force changes sign again at s = 1.41421: beyond, agents repel each other
        the force jumps from -143.4 to 0 at the range, s = 2.5
        """
        rest, zeros = self.resting_distance, self._parts.zeros
        remark = () if rest in (None, self.d) else (f"two agents rest at s = {rest:.6g}, not at length = {self.d:g}",)
        signs = (
            f"the force changes sign again at s = {s:.6g}: beyond, agents {'attract' if up else 'repel'} each other"
            for s, up in zeros
            if (s, up) != (rest, True)
        )
        return (*remark, *signs, *self._parts.ends)

    @property
    def resting_distance(self) -> float | None:
        """Length d if two agents rest there; else the first distance at which repulsion turns into attraction."""
        rising_zeros = [s for s, is_rising in self._parts.zeros if is_rising]
        return self.d if self.d in rising_zeros or not rising_zeros else rising_zeros[0]

    def __repr__(self) -> str:
        """Return the call that builds the law, with its remarks."""
        what = f"{self.potential!r}" if self.potential else f"force={self.force_formula!r}"
        numbers = f", parameters={dict(self.parameters)}" if self.parameters else ""
        call = f"pair_law({what}, adjacency={self.adjacency_formula!r}, range={self.r:g}, length={self.d:g}{numbers})"
        return f"{call} [{'; '.join(self.remarks)}]" if self.remarks else call

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...]:
        """Return bounds of |dF/ds| of force and |da/ds| of adjacency by parts of the range, or infinity.

        Parameters
        ----------
        parts : int
            Equal parts of the range, which are split where pieces of the formula meet.

        Examples
        --------
        >>> law = FormulaInteraction("s**2/2", r=2.0, adjacency_formula="1 - s/r")
        >>> [(bound.force, round(bound.adjacency, 9)) for bound in law.slopes(2)]
        [(1.0, 0.5), (1.0, 0.5)]
        """
        return self._parts.slopes(parts)

    @property
    def coincidence(self) -> bool:
        """Whether the force has a limit at distance 0."""
        return self._parts.coincidence

    @property
    def strength(self) -> float:
        """Largest force on a grid over (0, r), or over [d/2, 0.9 r] where it is unbounded."""
        return self._parts.strength

    @property
    def far_potential(self) -> float:
        """Potential of a pair at the range and beyond; infinite if the potential has a pole at the range."""
        return float(self._parts.par[1])

    @property
    def par(self) -> FloatArray:
        """Kernel parameters: r², ψ(r), ε, series at 0, cuts, constants of the formula."""
        return self._parts.par

    @property
    def panels(self) -> FloatArray:
        """Chebyshev panels of ψ: over the range if the force was given, else near 0 where the formula cancels."""
        return self._parts.panels

    def with_parameters(self, **parameters: float) -> FormulaInteraction:
        """Return the same formula with other parameter values; nothing is compiled again.

        Parameters
        ----------
        **parameters : float
            By name.

        Raises
        ------
        ArgumentError
            If the formula has no such parameter.
        """
        names = dict(self.parameters)
        unknown = sorted({*parameters} - {*names})
        if unknown:
            raise ArgumentError(f"{unknown[0]!r} is no parameter of the formula: expected {', '.join(names) or 'none'}")
        return replace(self, parameters=tuple((names | parameters).items()))

    def in_units(self, length: float, time: float) -> FormulaInteraction:
        """Return the law in other units (`flockana.rescale`).

        Raises
        ------
        ArgumentError
            If a parameter has no `powers`, or the formula has a number in it that has a unit.

        Notes
        -----
        A force without a time among its parameters' powers is a length, as φ_α is: its gain carries the time.
        """
        powers: dict[str, Powers] = {"eps": (-2, 0)} | {name: (a, b) for name, a, b in self.powers}
        missing = [name for name, _ in self.parameters if name not in powers]
        if missing:
            raise ArgumentError(
                f"parameter {missing[0]!r} has no powers of length and time: expected "
                f"units={{{missing[0]!r}: (1, 0), ...}} of pair_law, to change units"
            )
        scaled_parameters = tuple(
            (name, value * length ** powers[name][0] * time ** powers[name][1]) for name, value in self.parameters
        )
        rescaled_interaction = replace(self, r=self.r * length, d=self.d * length, parameters=scaled_parameters)
        force = length / time**2 if any(b for _, _, b in self.powers) else length
        if not self._parts.same_as(rescaled_interaction._parts, length, force, _SAME):
            raise ArgumentError(
                "the formula has a number in it that has a unit, or parameters with wrong powers: expected a force "
                "that scales as length/time², or as length if no parameter has a time, and an adjacency that scales as "
                "neither, to change units"
            )
        return rescaled_interaction

    def derivation(self) -> Derivation:
        """Return the derivation of potential, force, weight and adjacency, with LaTeX output."""
        from flockana.symbolic.pair_formula import pair_derivation

        return pair_derivation(self._parts.cut.formula)
