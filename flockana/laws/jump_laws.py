"""Laws with acceleration jumps across surfaces in space, at which `simulate` must stop."""

from abc import abstractmethod
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.laws.law import Law

Pieces = npt.NDArray[np.int8]


class Margins(NamedTuple):
    """Distances of pairs from the nearer jump of the force, negative beyond it, and its side."""

    inside: FloatArray
    upper: npt.NDArray[np.bool_]


class SwitchedLaw(Law):
    """Law with smooth pieces for each pair of agents, separated by jumps.

    A piece is an interval of the pair's distance. Where `located` is true, `simulate` integrates the pieces held as
    they are, stops where the first pair leaves its own, and goes on with the next; where a pair is driven back from
    both sides it holds at the surface (a Filippov sliding mode), which is reported and ends the run.
    """

    slide: ClassVar[str] = ": each side drives them into the other"  # end of the report

    @abstractmethod
    def pieces(self, q: FloatArray) -> Pieces:
        """Return for every pair the number of its interval of distances between jumps of the force."""

    @abstractmethod
    def piece_flow(self, pieces: Pieces, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return acceleration and energy rate, each pair's force continued smoothly beyond its jumps.

        Parameters
        ----------
        pieces : ndarray of int8
            From `pieces`.
        """

    @abstractmethod
    def margins(self, pieces: Pieces, q: FloatArray) -> Margins:
        """Return distances of pairs from the nearer jump of the force, negative beyond it, and its side.

        Parameters
        ----------
        pieces : ndarray of int8
            Where each pair is held.
        """

    @abstractmethod
    def crossed(self, pieces: Pieces, margins: Margins) -> Pieces:
        """Return the interval of each pair after every pair with a negative margin has crossed its jump.

        Parameters
        ----------
        pieces : ndarray of int8
            Before.
        margins : Margins
            At the switch.
        """

    @abstractmethod
    def held_speed(self, push: float) -> float:
        """Return the radial speed below which a pair counts as held at a surface.

        Parameters
        ----------
        push : float
            The lesser of the two accelerations that drive it back.
        """

    def sliding(self, before: Pieces, after: Pieces, t: float, q: FloatArray, p: FloatArray) -> str | None:
        """Return a description of the sliding mode on the surface just crossed; None without one.

        Parameters
        ----------
        before, after : ndarray of int8
            Pieces on the two sides.
        q, p : ndarray, shape (n, m)
            Positions and velocities at the switch.
        """
        rows, columns = np.triu_indices(len(q), 1)
        for k in np.flatnonzero(before != after):
            i, j = int(rows[k]), int(columns[k])
            x, v = q[j] - q[i], p[j] - p[i]
            rho = float(np.linalg.norm(x))
            speed = float(v @ x) / rho
            bend = (float(v @ v) - speed**2) / rho
            held_p = p.copy()  # at the surface the two neither approach nor recede: damping of that is no push
            held_p[i] += 0.5 * speed / rho * x
            held_p[j] -= 0.5 * speed / rho * x
            old_flow, new_flow = (self.piece_flow(side, t, q, held_p)[0] for side in (before, after))
            crossing_sign = 1.0 if after[k] > before[k] else -1.0
            leaving_rate, back = (crossing_sign * (float((u[j] - u[i]) @ x) / rho + bend) for u in (old_flow, new_flow))
            if leaving_rate > 0.0 > back and abs(speed) <= self.held_speed(min(leaving_rate, -back)):
                return f"agents {i} and {j} slide at distance {rho:.6g}{self.slide}"
        return None
