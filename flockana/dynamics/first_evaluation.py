"""Check of a law's first results before integration; errors name the law and the returned value."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import FloatArray, ensure_returned_array
from flockana.dynamics.run_samples import Start
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.law import Law


def first_call(law: Law | DiscreteLaw | VelocityLaw, t0: float, q0: FloatArray, p0: FloatArray) -> Start:
    """Return the start of a run; raise unless the law returns real numbers in the flock's shape, finite there."""
    name, time_text = law.title, f"at the start, t = {t0:g}"
    if isinstance(law, VelocityLaw):  # its velocities are checked already
        return Start(t0, q0, p0, law.acceleration(t0, q0))
    if isinstance(law, Law):
        u, power = law.checked_flow(t0, q0, p0)
        start = Start(t0, q0, p0, u, power, law.hamiltonian(t0, q0, p0))
        _check_finite(name, start, time_text)
        return start
    memory = {key: np.array(value) for key, value in law.start(q0, p0).items()}
    answer: Any = law.step(t0, q0.copy(), p0.copy(), memory)
    if not isinstance(answer, tuple) or len(answer) != 4 or not isinstance(answer[3], Mapping):
        raise ArgumentError(f"{name} gives {format_value(answer)} {time_text}: expected (q, p, u, memory)")
    for state_letter, value in zip("qpu", answer, strict=False):
        ensure_returned_array(f"{name} gives {state_letter}", value, q0.shape, time_text)
    public = {key: np.array(value) for key, value in law.start(q0, p0).items() if key not in law.private}
    return Start(t0, q0, p0, np.zeros_like(q0), memory=public)


def _check_finite(name: str, start: Start, at: str) -> None:
    """Raise unless accelerations and the energy's rate (if any) are finite."""
    u, energy = start.u, start.energy
    if not (is_finite := np.isfinite(u).all(axis=1)).all():
        i = int(np.argmin(is_finite))
        raise ArgumentError(f"{name} gives u[{i}] = {u[i]} {at}: expected finite accelerations there")
    if np.ndim(energy) != 0 or np.asarray(energy).dtype.kind not in "fiu":
        raise ArgumentError(
            f"{name} gives H = {format_value(energy)} {at}: expected a real number, or NaN without energy"
        )
    if start.energetic and not np.isfinite(start.power):
        raise ArgumentError(
            f"{name} gives H = {energy:g}, but dH/dt = {start.power} {at}: expected the rate of that energy, or H = "
            "NaN for a law without one"
        )
