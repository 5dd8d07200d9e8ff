"""Centre of mass of Algorithm 2 as a linear second-order system: transfer functions, poles, responses.

Pair forces cancel in the sum over agents, so q_c'' = −c1γ (q_c − q_r) − c2γ (q_c' − p_r), exactly, whatever the flock
does (Olfati-Saber 2006, section V). Every coordinate obeys the same scalar equation. With per-agent gains there is no
such equation, and these functions refuse.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_finite_scalar, ensure_series, real_array
from flockana.equilibria.curvature import EPS
from flockana.interactions import Gains
from flockana.laws import ensure_one_gain
from flockana.laws.discrete import DiscreteLaw

if TYPE_CHECKING:
    from control import FrequencyResponseData, TimeResponseData, TransferFunction


@dataclass(frozen=True)
class CentreOfMass:
    """Transfer function G(s) = (factor c2γ s + c1γ)/(s² + c2γ s + c1γ) from q_r to q_c, with p_r = factor dq_r/dt.

    Parameters
    ----------
    gains : Gains
        c1γ and c2γ are used.
    factor : float
        1 for the true velocity, 0 for a p_r held at zero, 0.009 for the MSN project's (erratum E12).

    Examples
    --------
    >>> centre = CentreOfMass(Gains(c1_gamma=4.0, c2_gamma=4.0))
    >>> centre.natural_frequency, centre.damping_ratio, centre.poles.real.tolist()
    (2.0, 1.0, [-2.0, -2.0])
    """

    gains: Gains
    factor: float = 1.0

    def __post_init__(self) -> None:
        ensure_one_gain(self.gains)
        object.__setattr__(self, "factor", ensure_finite_scalar("factor", self.factor))

    @property
    def natural_frequency(self) -> float:
        """ω_n = √c1γ, in radians per time unit."""
        return sqrt(self.gains.c1_gamma)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio ζ = c2γ/(2 √c1γ); infinite for c1γ = 0."""
        return float(self.gains.c2_gamma / (2.0 * self.natural_frequency)) if self.gains.c1_gamma > 0.0 else inf

    @property
    def discriminant(self) -> float:
        """Discriminant c2γ²/4 − c1γ; 0 within the rounding of critical damping c2γ = 2√c1γ."""
        c1, c2 = self.gains.c1_gamma, self.gains.c2_gamma
        radicand = float(0.25 * c2 * c2 - c1)
        return 0.0 if abs(radicand) <= 4.0 * EPS * c1 else radicand

    @property
    def falling(self) -> float:
        """Ratio c2γ²(1 − factor²)/2c1γ; for values >= 1, |G(jω)| falls as ω rises from 0 (erratum E15)."""
        c1, c2 = self.gains.c1_gamma, self.gains.c2_gamma
        return float(0.5 * c2 * c2 * (1.0 - self.factor**2) / c1) if c1 > 0.0 else inf

    @property
    def poles(self) -> npt.NDArray[np.complex128]:
        """Roots of s² + c2γ s + c1γ, the slower one last, computed without cancellation."""
        c1, c2 = self.gains.c1_gamma, self.gains.c2_gamma
        root = np.sqrt(complex(self.discriminant))
        far_pole = -(0.5 * c2 + root)
        return np.array([far_pole, c1 / far_pole if root.real > 0.0 else np.conj(far_pole)], dtype=np.complex128)

    @property
    def period(self) -> float:
        """Period 2π/√(c1γ − c2γ²/4) of the damped oscillation; infinite without an oscillation."""
        return 2.0 * pi / sqrt(-self.discriminant) if self.discriminant < 0.0 else inf

    def system(self) -> TransferFunction:
        """Return the transfer function G(s) of the centre as a `control.TransferFunction`."""
        import control

        c1, c2 = self.gains.c1_gamma, self.gains.c2_gamma
        return control.TransferFunction([self.factor * c2, c1], [1.0, c2, c1], inputs="q_r", outputs="q_c")

    def response(self, omega: Any) -> Any:
        """Return the centre's frequency response G(jω), complex, in the shape of `omega`.

        Parameters
        ----------
        omega : float or array_like
            Angular frequency, in radians per time unit.
        """
        try:
            s = 1j * real_array(omega)
        except (TypeError, ValueError, OverflowError):
            raise ArgumentError(f"omega = {format_value(omega)}: expected real numbers") from None
        c1, c2 = self.gains.c1_gamma, self.gains.c2_gamma
        return (self.factor * c2 * s + c1) / (s * s + c2 * s + c1)

    def step_response(self, t: Any) -> TimeResponseData:
        """Return q_c after a unit step of q_r with p_r = 0 throughout, by python-control.

        A γ-agent that jumps has no velocity to tell; `system()` has p_r = factor dq_r/dt, an impulse at a step.

        Parameters
        ----------
        t : array_like, shape (T,)
            Equally spaced times from 0.
        """
        import control

        return control.step_response(CentreOfMass(self.gains, 0.0).system(), ensure_series("t", t))

    def frequency_response(self, omega: Any) -> FrequencyResponseData:
        """Return magnitude and phase of the centre's response over frequency, by python-control.

        Parameters
        ----------
        omega : array_like, shape (F,)
            Angular frequencies, in radians per time unit.
        """
        import control

        return control.frequency_response(self.system(), ensure_series("omega", omega))


def predicted_gain(gains: Gains, omega: float, *, factor: float = 1.0) -> float:
    """Return |G(jω)|, the ratio of the flock's amplitude to the γ-agent's on a circle or sine.

    Parameters
    ----------
    gains : Gains
        c1γ and c2γ are used.
    omega : float
        Angular frequency, in radians per time unit.
    factor : float
        p_r over dq_r/dt.

    Examples
    --------
    >>> round(predicted_gain(Gains(c1_gamma=4.0, c2_gamma=3.0), 2.0, factor=0.0), 6)
    0.666667
    """
    return float(abs(CentreOfMass(gains, factor).response(ensure_finite_scalar("omega", omega))))


def map_gain(law: DiscreteLaw, omega: float, *, factor: float = 1.0) -> float:
    """Return the amplitude ratio |G_q(e^jωh) + factor jω G_p(e^jωh)| of a map's centre to the γ-agent."""
    omega, system = ensure_finite_scalar("omega", omega), law.centre_system()
    if system is None:
        raise ArgumentError(f"{type(law).__name__}: expected a map whose centre of mass follows a target linearly")
    by_position, by_velocity = system(np.exp(1j * omega * law.dt)).ravel()
    return float(abs(by_position + factor * 1j * omega * by_velocity))
