"""Laws with jumps: location of the first time in a step at which a pair leaves its smooth piece."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.polynomial import chebyshev

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.interpreted_steps import Interpreter
from flockana.dynamics.moving_frame import Plan
from flockana.dynamics.run_samples import Samples, Start
from flockana.laws.jump_laws import Pieces, SwitchedLaw

Way = Callable[[float], FloatArray]

_HALVINGS = 60  # of a step, until the switch is bracketed to rounding
_DEGREE = 12  # of a step's interpolant, at most: LSODA's; DOP853 has 7
_NODES = chebyshev.chebpts1(2 * _DEGREE + 1)  # so many that a squared distance is its own interpolant
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, 2 * _DEGREE))


class SwitchingInterpreter(Interpreter):
    """Integrator of a law with jumps: each pair keeps one smooth formula from switch to switch.

    A pair held at a surface (a Filippov sliding mode) would switch ever more frequently: it ends the run.
    """

    law: SwitchedLaw

    def __init__(self, law: SwitchedLaw, start: Start, plan: Plan) -> None:
        self.pieces = law.pieces(start.q)
        self._crossed: Pieces | None = None  # after the last step, if a switch ends it
        self._beside: Samples | None = None
        super().__init__(law, start, plan)
        self.notes = {"switches": 0}
        self.first = self.first and self.first._replace(u=self.flow(*start[:3])[0][None])

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return accelerations and energy rate, each pair's smooth formula continued past its switches."""
        return self.law.piece_flow(self.pieces, t, q, p)

    def advance(self) -> int:
        """Make one step, cut at the first switch of a pair; a sliding mode there ends the run."""
        if not self.step():
            return 0
        t, end = self.block.t.tolist()
        switch = first_switch(self.law, self.pieces, lambda s: self.frame.state(s, self.course(s))[0], t, end)
        if switch is not None:
            y = self.course(switch)
            self.block.t[1], self.block.y[1], self.block.f[1] = switch, y, self.frame.rate(self.flow)(switch, y)
            q, p = self.frame.state(switch, y)
            self._crossed = self.law.crossed(self.pieces, self.law.margins(self.pieces, q))
            self.notes["switches"] += 1
            sliding_text = self.law.sliding(self.pieces, self._crossed, switch, q, p)
            if sliding_text is not None:
                self.notes["sliding"], self.failure = sliding_text, f"sliding at t = {switch:.6g}: {sliding_text}"
        return 1

    def samples(self, count: int) -> Iterator[Samples]:
        """Yield samples as the base class does, with an extra step just after a switch."""
        if self._beside is not None and self._beside.t < min([self.block.t[1], *self.due[:1]]):
            yield self._beside
        self._beside = None
        yield from super().samples(count)

    def describe_failure(self, steps: int, count: int) -> str:
        """Return why the run ends, such as a pair in a sliding mode; '' if it continues."""
        return self.failure

    def continue_from(self, count: int) -> None:
        """Continue from the end of the step just made, with each pair's formula after a switch."""
        super().continue_from(count)
        if self._crossed is not None:
            self.pieces, self._crossed = self._crossed, None
            self.begin()
            (t, y, f, _), n = (rows[:1] for rows in self.block), self.frame.size
            q, p = (item[None] for item in self.frame.state(float(t[0]), y[0]))
            gap = 4.0 * float(np.spacing(abs(t[0])))  # from there the path continues with the other side's input
            self._beside = Samples(t + gap, q + gap * p, p, f[:, n : 2 * n].reshape(q.shape).copy(), {}, wanted=False)


def first_switch(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> float | None:
    """Return the first time in a step at which a pair crosses a switching distance of the law, or None.

    Between two turns every distance that could reach an edge is monotone: no pair can have left and be back.
    """

    def beyond(t: float) -> bool:
        return bool((law.margins(pieces, way(t)).inside < 0.0).any())

    low = start
    for t in [*turns(law, pieces, way, start, end), end]:
        if beyond(t):
            high = t
            for _ in range(_HALVINGS):
                midpoint = 0.5 * (low + high)
                if not low < midpoint < high:
                    break
                low, high = (low, midpoint) if beyond(midpoint) else (midpoint, high)
            return float(high)
        low = t
    return None


def turns(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> list[float]:
    """Return the times within a step at which the distance of a pair that may switch has an extremum, rising."""
    # The interpolant of every solver is a polynomial, and so are the squares of distances: their turns are roots. Only
    # pairs are asked whose two agents' ways, each bounded by the coefficients of its series, could reach an edge.
    times = 0.5 * (start + end) + 0.5 * (end - start) * _NODES
    positions = np.stack([way(t) for t in times.tolist()])  # (nodes, n, m)
    series = np.tensordot(_TO_SERIES, positions, axes=1)
    reach = np.sum(lengths(series[1:]), axis=0)  # an agent's way from its mean place, series[0]
    rows, columns = np.triu_indices(len(reach), 1)
    may_switch = law.margins(pieces, series[0]).inside <= (reach[rows] + reach[columns]) * (1.0 + 1e-9)
    times_of_turns: set[float] = set()
    for i, j in zip(rows[may_switch].tolist(), columns[may_switch].tolist(), strict=True):
        squared = _TO_SERIES @ np.sum((positions[:, j] - positions[:, i]) ** 2, axis=1)
        roots = chebyshev.chebroots(chebyshev.chebder(chebyshev.chebtrim(squared, 1e-15 * abs(squared).max())))
        real = roots.real[np.abs(roots.imag) < 1e-6]
        times_of_turns.update((0.5 * (start + end) + 0.5 * (end - start) * real[np.abs(real) < 1.0]).tolist())
    return sorted(t for t in times_of_turns if start < t < end)
