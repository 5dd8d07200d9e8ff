"""Numerical thresholds used to judge the claims of theorems."""

from dataclasses import dataclass, fields

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import ensure_nonnegative, ensure_positive


@dataclass(frozen=True)
class Tolerances(ShortRepr):
    """Thresholds used in verdicts, shown with each verdict.

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
            ensure_number = ensure_nonnegative if field_.name == "settle" else ensure_positive
            value = ensure_number(f"tolerances.{field_.name}", getattr(self, field_.name))
            if field_.name in ("giant", "settle") and value >= 1.0:
                raise ArgumentError(f"tolerances.{field_.name} = {value:g}: expected a share below 1")
            object.__setattr__(self, field_.name, value)
