"""Laws with jumps: the first time within a step at which a pair leaves its smooth piece is located."""

from collections import deque
from collections.abc import Callable, Iterator

import numpy as np
from numpy.polynomial import chebyshev

from flockana.base.checks import FloatArray
from flockana.base.vectors import lengths
from flockana.dynamics.interpreted import Interpreter
from flockana.dynamics.sample import Sample, Start, Tally
from flockana.laws.switched import Pieces, SwitchedLaw

Way = Callable[[float], FloatArray]

_HALVINGS = 60  # of a step, until the switch is bracketed to rounding
_DEGREE = 12  # of a step's interpolant, at most: LSODA's; DOP853 has 7
_NODES = chebyshev.chebpts1(2 * _DEGREE + 1)  # so many that a squared distance is its own interpolant
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, 2 * _DEGREE))


class Switches:
    """Flow with every pair held in its smooth piece until one leaves it.

    A pair held at a surface (a Filippov sliding mode) would switch ever more frequently: `cross` reports it.
    """

    def __init__(self, law: SwitchedLaw, q0: FloatArray) -> None:
        self.law, self.pieces, self.count = law, law.pieces(q0), 0

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """As `Law.flow`, every pair's piece continued smoothly beyond its edges."""
        return self.law.piece_flow(self.pieces, t, q, p)

    def first(self, way: Way, start: float, end: float) -> float | None:
        """The first time at which a pair is beyond its piece, however short the visit; None if there is none."""
        return first_switch(self.law, self.pieces, way, start, end)

    def cross(self, t: float, q: FloatArray, p: FloatArray) -> str | None:
        """Move pairs to their pieces after a switch; return in words what slides there, None if nothing does."""
        before = self.pieces
        self.pieces, self.count = self.law.crossed(before, self.law.margins(before, q)), self.count + 1
        return self.law.sliding(before, self.pieces, t, q, p)


def switched(
    solver: Interpreter, switches: Switches, start: Start, keep: FloatArray | None, tally: Tally
) -> Iterator[Sample]:
    """Steps from switch to switch, and samples at times to keep; a sliding mode ends the run."""
    frame, flow, t = solver.frame, switches.flow, solver.frame.t0
    due, beside = deque([] if keep is None else keep.tolist()), None

    def sample(t: float, y: FloatArray) -> Sample:
        q, p = frame.state(t, y)
        return Sample(t, q, p, flow(t, q, p)[0], {"work": np.array(y[-1])} if frame.energetic else {})

    if keep is None or due[0] == t:
        yield start.sample._replace(u=flow(t, start.q, start.p)[0])  # not a rounding beside it, as in the frame
        _drop(due, t)
    tally.notes["switches"] = 0
    while solver.stops.size:
        stepped = solver.step()
        tally.evaluations = solver.evaluations
        if not stepped:
            tally.fail(solver.failure)
            return
        tally.steps += 1
        end, y = float(solver.block.t[1]), solver.block.y[1].copy()
        switch = switches.first(lambda s: frame.state(s, solver.course(s))[0], t, end)
        if switch is not None:
            end, y = switch, solver.course(switch)
        reached, t = sample(end, y), end
        if beside is not None and beside.t < (min(t, due[0]) if due else t):
            yield beside
        beside = None
        while due and due[0] < t:
            yield sample(due[0], solver.course(due[0]))
            due.popleft()
        yield reached._replace(wanted=_drop(due, t) or keep is None)
        if switch is None:
            solver.continue_from(1)
            continue
        sliding = switches.cross(t, reached.q, reached.p)
        tally.notes["switches"] = switches.count
        if sliding is not None:
            tally.notes["sliding"] = sliding
            tally.fail(f"sliding at t = {t:.6g}: {sliding}")
            return
        solver.begin(flow, t, y)
        beside = _sample_after(sample(t, y))


def _drop(due: deque[float], t: float) -> bool:
    """Remove a time from those due for a sample; return whether it was due."""
    return bool(due) and due[0] == t and due.popleft() == t


def _sample_after(switch: Sample) -> Sample:
    """Return a second sample just after a switch, from which the path continues with the other side's input."""
    gap = 4.0 * float(np.spacing(abs(switch.t)))
    return switch._replace(t=switch.t + gap, q=switch.q + gap * switch.p, wanted=False)


def first_switch(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> float | None:
    """The first time at which a pair is beyond its piece; None if there is none.

    Between two turns every distance that could reach an edge is monotone: no pair can have left and be back.
    """

    def beyond(t: float) -> bool:
        return bool((law.margins(pieces, way(t)).inside < 0.0).any())

    low = start
    for t in [*turns(law, pieces, way, start, end), end]:
        if beyond(t):
            high = t
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                if not low < middle < high:
                    break
                low, high = (low, middle) if beyond(middle) else (middle, high)
            return float(high)
        low = t
    return None


def turns(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> list[float]:
    """Return the times within a step at which the distance of a pair that may switch has an extremum, rising."""
    # The interpolant of every solver is a polynomial, and so are the squares of distances: their turns are roots. Only
    # pairs are asked whose two agents' ways, each bounded by the coefficients of its series, could reach an edge.
    times = 0.5 * (start + end) + 0.5 * (end - start) * _NODES
    places = np.stack([way(t) for t in times.tolist()])  # (nodes, n, m)
    series = np.tensordot(_TO_SERIES, places, axes=1)
    reach = np.sum(lengths(series[1:]), axis=0)  # an agent's way from its mean place, series[0]
    rows, columns = np.triu_indices(len(reach), 1)
    near = law.margins(pieces, series[0]).inside <= (reach[rows] + reach[columns]) * (1.0 + 1e-9)
    times_of_turns: set[float] = set()
    for i, j in zip(rows[near].tolist(), columns[near].tolist(), strict=True):
        squared = _TO_SERIES @ np.sum((places[:, j] - places[:, i]) ** 2, axis=1)
        roots = chebyshev.chebroots(chebyshev.chebder(chebyshev.chebtrim(squared, 1e-15 * abs(squared).max())))
        real = roots.real[np.abs(roots.imag) < 1e-6]
        times_of_turns.update((0.5 * (start + end) + 0.5 * (end - start) * real[np.abs(real) < 1.0]).tolist())
    return sorted(t for t in times_of_turns if start < t < end)
