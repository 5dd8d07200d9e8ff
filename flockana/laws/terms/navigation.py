"""The γ-term: the pull of every agent to the γ-agent, linear (Algorithm 2) or bounded (Algorithm 3)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.environment.target import Harmonic, Target
from flockana.interactions.gains import Gains, weighted
from flockana.kernels import navigation as kernel
from flockana.laws.law_features import Feature, target_feature
from flockana.laws.terms.term import Invariance, Term, TermKernel
from flockana.measures.centre_frame import moving_frame


@dataclass(frozen=True)
class Navigation(Term):
    """u_i^γ = −c1γ ℓ σ₁((q_i − q_r)/ℓ) − c2γ (p_i − p_r); without ℓ linear, −c1γ (q_i − q_r) − c2γ (p_i − p_r).

    A linear pull with one gain for all moves the shape of a flock and its centre apart, for every target, consistent or
    not. Its energy is then that of the shape, c1γ J(x) = ½ c1γ Σ‖x_i‖² in the moving frame. Else it is
    Σ c1γ_i ℓ² (√(1 + ‖q_i − q_r‖²/ℓ²) − 1), whose limit for a long ℓ is ½ Σ c1γ_i ‖q_i − q_r‖². The force knows the p_r
    that it is told, this potential moves with the true dq_r/dt.

    Parameters
    ----------
    gains : Gains
        c1_gamma and c2_gamma are used.
    unit : float, optional
        ℓ, the length that σ₁ counts in; None for the linear pull.
    given : bool
        Whether the energy is that in the given frame whatever the pull, as where the shape is tied to a place or speed.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> term, u = Navigation(StaticTarget((3.0,)), Gains(c1_gamma=2.0)), np.zeros((1, 1))
    >>> term.act(0.0, np.zeros((1, 1)), np.zeros((1, 1)), u), u.tolist(), term.moving
    (-0.0, [[6.0]], True)
    """

    target: Target
    gains: Gains
    unit: float | None = None
    given: bool = False

    functions = ()

    def features(self) -> tuple[Feature, ...]:
        """Return the shortest time scale of the γ-agent's motion, as a feature in time."""
        return (target_feature(self.target),)

    @property
    def moving(self) -> bool:  # noqa: D102
        return self.unit is None and not self.gains.per_agent and not self.given

    @property
    def invariance(self) -> Invariance:  # noqa: D102
        return "rigid motions" if self.moving else "rotations about the target"

    @cached_property
    def _gains(self) -> tuple[FloatArray, FloatArray]:
        """Gains c1γ and c2γ, each a number or one per agent."""
        c1, c2 = np.broadcast_arrays(*(np.ravel(gain) for gain in (self.gains.c1_gamma, self.gains.c2_gamma)))
        return c1.astype(np.float64), c2.astype(np.float64)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if self.target.dimension != m:
            raise ArgumentError(
                f"the target has {self.target.dimension} components but the agents have {m}: expected equal dimensions"
            )

    def check_agents(self, n: int) -> None:  # noqa: D102
        self.gains.check_agents(n)

    def _bend(self, x: FloatArray) -> FloatArray:
        """Return √(1 + ‖x_i‖²/ℓ²), the divisor of each agent's bounded pull, shape (n,); 1 for the linear pull."""
        if self.unit is None:
            return np.ones(len(x))
        return np.sqrt(1.0 + np.einsum("ij,ij->i", x, x) / self.unit**2)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        form = self._straight_form
        if form is None:
            (q_r, p_r), rate = self.target.state(t), self.target.rate(t)
            zeros = np.zeros_like(rate)
            t, form = 0.0, self._along(Harmonic(np.array([q_r, rate, zeros, zeros, p_r]), factor=0.0))
        return form.on_agents(t, q, p, u)

    def _along(self, path: Harmonic) -> TermKernel:
        """Return the γ-term in compiled form, for a target on the given harmonic path."""
        c1, c2 = self._gains
        head = [self.moving, self.unit or 0.0, c1.size, path.omega, path.factor]
        kernel_parameters = np.concatenate([head, path.terms.ravel(), c1, c2])
        return TermKernel(kernel.act, kernel.energy, kernel_parameters, np.empty((0, 0)), 0.0)

    @cached_property
    def _straight_form(self) -> TermKernel | None:
        """Compiled γ-term for a target at rest or on a line, where it is exact to the last bit; else None."""
        path = self.target.closed_path
        return None if path is None or path.omega else self._form

    @cached_property
    def _form(self) -> TermKernel | None:
        """Compiled γ-term for a target with a harmonic path; None for other targets."""
        path = self.target.closed_path
        return None if path is None else self._along(path)

    def compiled(self, m: int) -> TermKernel | None:  # noqa: D102
        return self._form

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        x = moving_frame(q) if self.moving else q - self.target.state(t)[0]
        x2 = np.einsum("ij,ij->i", x, x)
        return weighted(self.gains.c1_gamma, x2 / (self._bend(x) + 1.0))  # √(1 + x²) − 1 without its cancellation

    def target_derivatives(self, t: float, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(∂u_i/∂q_r, ∂u_i/∂p_r), two arrays of blocks (n, m, m): c1γ times the derivative of σ₁, and c2γ I."""
        pull = np.broadcast_to(np.eye(q.shape[1]), (*q.shape, q.shape[1]))
        drag = pull
        if self.unit is not None:
            x = q - self.target.state(t)[0]
            root, x = self._bend(x)[:, None, None], x / self.unit
            pull = np.eye(q.shape[1]) / root - x[:, :, None] * x[:, None, :] / root**3
        return np.reshape(self.gains.pull, (-1, 1, 1)) * pull, np.reshape(self.gains.drag, (-1, 1, 1)) * drag

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        pull, drag = self.target_derivatives(t, q)
        return -pull, -drag

    def hessian(self, t: float, q: FloatArray) -> FloatArray:
        """Return the second derivative of `energy` by positions, or by deviations in the moving frame."""
        return self.target_derivatives(t, q)[0]
