"""Linearised flock with its analyses: tables, margins, norms, responses, controllability, plant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.files import atomic_write
from flockana.base.value_checks import ensure_known, ensure_nonnegative, ensure_series
from flockana.stability.cost_estimates import LIMIT, ensure_study
from flockana.stability.linear_flock import LinearFlock

if TYPE_CHECKING:
    import os

    from control import FrequencyResponseData, StateSpace

    from flockana.stability.chain_disturbances import Passivity, StringGains, TransientGrowth
    from flockana.stability.controllability import Controllability
    from flockana.stability.damp_table import DampTable
    from flockana.stability.delay import DelayMargin
    from flockana.stability.packet_loss import LossMargin
    from flockana.stability.robustness import RobustnessMargins
    from flockana.stability.sampling import SamplingMargin

_BESIDE, _FREQUENCIES = 30.0, 400  # times the fastest pole and a thirtieth of the slowest: the range of a response


class ShapeNorms(NamedTuple):
    """Norms from a force on each agent to the deviation of the shape, and the frequency of the largest gain."""

    h2: float
    hinf: float
    peak: float


class Linearisation(LinearFlock):  # noqa: D101  # documented by its base, whose fields it has
    def damp(self, *, settled: float = 0.02) -> DampTable:
        """Return a table of all poles by rising natural frequency, as MATLAB's `damp` prints them.

        Columns are pole, damping ratio, natural frequency, time constant and settling time; rows bear the names of the
        modes. Zero modes come first, without a damping ratio.

        Parameters
        ----------
        settled : float
            Share of a deviation at which it counts as settled.
        """
        from flockana.stability.damp_table import damp_table

        poles = [(mode.name, mode.eigenvalue) for mode in self.modes]
        pairs = [(name, s.conjugate()) for name, s in poles if s.imag]
        zeros = [(mode.name, 0j) for mode in self.zero_modes]
        zeros += [("drift", 0j)] * (len(self.eigenvalues) - len(poles) - len(pairs) - len(zeros))
        return damp_table([*zeros, *poles, *pairs], settled=settled)

    def delay_margin(
        self,
        *,
        delayed: str = "all",
        carries: str = "both",
        links: Any = None,
        sampled: float | None = None,
        progress: bool = False,
        limit: float = LIMIT,
    ) -> DelayMargin:
        """Return the longest delay for which the flock is stable.

        Parameters
        ----------
        delayed, carries, links
            What is late: see `flockana.stability.delay_system`.
        sampled : float, optional
            Period of a zero-order hold by which the delayed input is sampled; then the margin is found by search.
        progress : bool
            Whether to show a bar of a long search.
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.delay import delay_margin, delayed_flock
        from flockana.stability.sampled_delays import sampled_delay_margin

        system = delayed_flock(self, delayed, carries, links)
        if sampled is None:
            return delay_margin(system, progress=progress, limit=limit)
        return sampled_delay_margin(system, sampled, limit=limit)

    def sampling_margin(
        self,
        *,
        delay: float = 0.0,
        delayed: str = "all",
        carries: str = "both",
        links: Any = None,
        limit: float = LIMIT,
    ) -> SamplingMargin:
        """Return the longest zero-order-hold period for which the flock is stable.

        Parameters
        ----------
        delay : float
            Delay of the sampled input, whatever the period; then the margin is found by search.
        delayed, carries, links
            What is late: see `flockana.stability.delay_system`.
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.delay import delayed_flock
        from flockana.stability.sampled_delays import delayed_sampling_margin
        from flockana.stability.sampling import margin_of_flow

        if ensure_nonnegative("delay", delay) == 0.0:
            return margin_of_flow("hold", self, limit=limit)
        return delayed_sampling_margin(delayed_flock(self, delayed, carries, links), delay, limit=limit)

    def robustness(self, *, limit: float = LIMIT) -> RobustnessMargins:
        """Return gain, phase and disk margins of the loops broken at each agent's input.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.robustness import loop_margins

        return loop_margins(self, limit)

    def loss_margin(self, period: float, *, lost: str = "agent", on_loss: str = "zero") -> LossMargin:
        """Return the largest mean-square stable packet loss: see `flockana.stability.loss_margin`.

        Parameters
        ----------
        period : float
            Sampling period.
        lost, on_loss : str
            What is lost at once, and what acts instead.
        """
        from flockana.stability.packet_loss import loss_margin

        return loss_margin(self, period, lost=lost, on_loss=on_loss)

    def string_gains(self, first: int = 0, *, limit: float = LIMIT) -> StringGains:
        """Return the H∞ norms from the motion of one agent to the others': see `flockana.stability.string_gains`.

        Parameters
        ----------
        first : int
            The agent that is moved.
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.chain_disturbances import string_gains

        return string_gains(self, first, limit=limit)

    def transient_growth(self, *, limit: float = LIMIT) -> TransientGrowth:
        """Return the largest transient growth: see `flockana.stability.transient_growth`.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.chain_disturbances import transient_growth

        return transient_growth(self, limit=limit)

    def passivity(self) -> Passivity:
        """Return whether the flock is passive from forces to velocities: see `flockana.stability.passivity`."""
        from flockana.stability.chain_disturbances import passivity

        return passivity(self)

    def norms(self, *, limit: float = LIMIT) -> ShapeNorms:
        """Return the H₂ and H∞ norms from a force on each agent to the shape, without rigid motions.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        from flockana.stability.norms import disturbance_system, h2_norm, hinf_norm
        from flockana.stability.second_order_blocks import blocks

        ensure_study("the norms", self.q.size, limit)
        system = disturbance_system(blocks(self.stiffness.toarray(), self.damping.toarray(), self.q))
        return ShapeNorms(h2_norm(system), *hinf_norm(system))

    def response(self, input: str, output: str, omega: Any = None) -> FrequencyResponseData:
        """Return the frequency response from one named input to one named output of `state_space`.

        Parameters
        ----------
        input, output : str
            Such as "f0_x", a force on agent 0, or "qr_x", the γ-agent's place; and "qc_x", the centre, or "l0_1", the
            length of a link.
        omega : array_like, shape (F,), optional
            Angular frequencies, in radians per time unit; by default around the poles.
        """
        import control

        state_space = self.state_space
        ensure_known("input", input, state_space.input_labels)
        ensure_known("output", output, state_space.output_labels)
        channel = state_space[state_space.output_labels.index(output), state_space.input_labels.index(input)]
        rates = np.abs(self.eigenvalues)
        rates = rates[rates > 0.0] if rates.any() else np.ones(1)
        grid = np.geomspace(rates.min() / _BESIDE, rates.max() * _BESIDE, _FREQUENCIES)
        omega = grid if omega is None else ensure_series("omega", omega)
        return control.frd(
            np.ravel(channel(1j * omega)), omega, inputs=[input], outputs=[output], name=f"{input} to {output}"
        )

    def controllability(self, informed: Any, *, horizon: float | None = None) -> Controllability:
        """Return the motions reached by forces on informed agents: see `flockana.stability.controllability`.

        Parameters
        ----------
        informed : sequence of int
            Agents on which forces act.
        horizon : float, optional
            Time of the Gramian; by default for ever, off the motions that nothing brings back.
        """
        from flockana.stability.controllability import controllability

        return controllability(self, informed, horizon=horizon)

    def plant(self, inputs: Any = "all") -> StateSpace:
        """Return the open-loop plant for synthesis, without feedback to some inputs.

        Parameters
        ----------
        inputs : "all", or sequence of int or str
            Agents, or components of their inputs such as "u3_x". Their own law does not act; all others keep theirs.

        Returns
        -------
        control.StateSpace
            States and outputs q0_x, …, p0_x, …, all measured; inputs u0_x, …, the accelerations that are free. With
            u = −F x and F the rows of [K D] for these inputs it is the flock again.
        """
        import control

        from flockana.stability.controllability import ensure_agents
        from flockana.stability.signal_names import labels

        n, m = self.q.shape
        names = labels("u", n, m)
        if isinstance(inputs, str) and inputs == "all":
            input_indices = list(range(n * m))
        elif np.size(inputs) and all(isinstance(input_name, str) for input_name in np.atleast_1d(inputs).tolist()):
            input_names = np.atleast_1d(inputs).tolist()
            input_indices = [names.index(ensure_known("input", input_name, names)) for input_name in input_names]
        else:
            input_indices = [i * m + c for i in ensure_agents("inputs", inputs, n) for c in range(m)]
        a, b = self.A.copy(), np.zeros((2 * n * m, len(input_indices)))
        rows = n * m + np.array(input_indices)
        a[rows], b[rows, np.arange(len(input_indices))] = 0.0, 1.0
        states, chosen_names = labels("q", n, m) + labels("p", n, m), [names[k] for k in input_indices]
        readings, zero_matrix = np.eye(2 * n * m), np.zeros((2 * n * m, len(input_indices)))
        return control.ss(a, b, readings, zero_matrix, states=states, inputs=chosen_names, outputs=states, name="plant")

    def to_mat(self, path: str | os.PathLike[str]) -> None:
        """Write A, B, C, D of `state_space` and the names of its signals to a MATLAB file.

        Parameters
        ----------
        path : str or path
            File to write, ending in .mat.
        """
        from scipy.io import savemat

        if not str(path).endswith(".mat"):
            raise ArgumentError(f"path = {str(path)!r}: expected a name that ends in .mat")
        system = self.state_space
        parts: dict[str, Any] = {name: getattr(system, name) for name in "ABCD"}
        for name in ("state", "input", "output"):
            parts[f"{name}s"] = np.array(getattr(system, f"{name}_labels"), dtype=object)
        with atomic_write(path) as partial:
            savemat(partial, parts)
