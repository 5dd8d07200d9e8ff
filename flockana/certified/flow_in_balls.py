"""Right-hand side of Algorithms 1 to 3, the laws that `enclose` supports, on balls and on power series in time (Arb).

A state is a list of 2 n m numbers, all coordinates of q and then all of p, agent by agent. What is written here for one
number holds for a ball (`arb`: an enclosure over all states in a box, also across the distances where the pair law is
only C¹) and for a series (`arb_series`: on one piece of each pair's law).
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import sqrt
from typing import Any

from flint import arb, arb_mat, arb_series, fmpq

from flockana.base.errors import ArgumentError, format_value
from flockana.certified.agent_forces_in_balls import AgentTerm, Pull, SphereTerm
from flockana.certified.balls import exact, minus, norm2, series_length
from flockana.certified.krawczyk import column, identity
from flockana.certified.pair_laws_in_series import PairNumbers, Piece
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, ensure_one_gain

_LED = (Algorithm2, Algorithm3)
Pieces = tuple[Piece, ...]  # of the pairs (0, 1), (0, 2), ..., then of the agents of each term


@dataclass(frozen=True)
class Flow:
    """Right-hand side q' = p, p' = u(t, q, p) of Algorithm 1, 2 or 3 in balls."""

    n: int  # n, m: Agents and dimension
    m: int
    pair: PairNumbers  # The pair law
    stiffness: arb  # stiffness, damping: c1α and c2α
    damping: arb
    pace: float  # About the law's fastest rate, by which steps and coordinates are proposed; nothing rests on it
    terms: tuple[AgentTerm, ...] = ()  # What acts on each agent by itself: the γ-agent, obstacles

    def pieces(self, state: Sequence[arb]) -> Pieces:
        """Return the smooth piece of each pair's and agent's force law that holds on a box of states."""
        q = self.split(state)[0]
        pairs = [self.pair.piece(norm2(minus(q[i], q[j]))) for i, j in combinations(range(self.n), 2)]
        return (*pairs, *(term.piece(x) for term in self.terms for x in q))

    def split(self, state: Sequence[Any]) -> tuple[list[Sequence[Any]], list[Sequence[Any]]]:
        """Return positions and velocities of a state, each as a list of agents."""
        m, half = self.m, self.n * self.m
        return [state[k : k + m] for k in range(0, half, m)], [state[k : k + m] for k in range(half, 2 * half, m)]

    def input(self, t: Any, state: Sequence[Any], pieces: Pieces) -> list[Any]:
        """Return the accelerations u(t, q, p) of all agents, coordinate by coordinate."""
        (q, p), m = self.split(state), self.m
        u: list[list[Any]] = [[0 * q[0][0]] * m for _ in range(self.n)]
        for i, j, piece, displacement, relative in self._pairs(q, p, pieces):
            stress, adjacency = self.pair.pair(norm2(displacement), piece)
            stress, adjacency = self.stiffness * stress, self.damping * adjacency
            for k in range(m):
                force = stress * displacement[k] + adjacency * relative[k]
                u[i][k], u[j][k] = u[i][k] + force, u[j][k] - force
        for k, i, piece in self._agents(pieces):
            u[i] = [a + b for a, b in zip(u[i], self.terms[k].force(t, q[i], p[i], piece), strict=True)]
        return [x for agent in u for x in agent]

    def powers(self, state: Sequence[Any], pieces: Pieces) -> list[Any]:
        """Return the summands of dH/dt: −c2α Σ a_ij ‖p_j − p_i‖² and those of γ-agent and obstacles."""
        q, p = self.split(state)
        heat, powers = 0 * q[0][0], [0 * q[0][0] for _ in self.terms]
        for _, _, piece, displacement, relative in self._pairs(q, p, pieces):
            adjacency = self.pair.pair(norm2(displacement), piece)[1]
            if isinstance(adjacency, arb):
                adjacency = adjacency.nonnegative_part()  # ρ_h >= 0, whatever its ball says
            heat = heat + adjacency * norm2(relative)
        for k, i, piece in self._agents(pieces):
            powers[k] = powers[k] + self.terms[k].power(q[i], p[i], piece)
        return [-self.damping * heat, *powers]

    def slopes(self, t: Any, state: Sequence[Any], pieces: Pieces) -> tuple[list[list[Any]], list[list[Any]]]:
        """Return the Jacobians (∂u/∂q, ∂u/∂p) of the accelerations as two square tables."""
        (q, p), m, size = self.split(state), self.m, self.n * self.m
        by_q, by_p = ([[0] * size for _ in range(size)] for _ in range(2))
        for i, j, piece, displacement, relative in self._pairs(q, p, pieces):
            s2 = norm2(displacement)
            (stress, adjacency), (weight_slope, fade) = self.pair.pair(s2, piece), self.pair.slopes(s2, piece)
            stress, drag = self.stiffness * stress, self.damping * adjacency
            weight_slope, fade = self.stiffness * weight_slope, self.damping * fade
            gradient = [2 * (weight_slope * x + fade * w) for x, w in zip(displacement, relative, strict=True)]
            for k in range(m):
                _couple(by_p, m, i, j, k, k, drag)
                for h in range(m):
                    _couple(by_q, m, i, j, k, h, gradient[k] * displacement[h] + (stress if k == h else 0))
        for number, i, piece in self._agents(pieces):
            blocks = self.terms[number].slopes(t, q[i], p[i], piece)
            for table, block in zip((by_q, by_p), blocks, strict=True):
                for k, h in product(range(m), repeat=2):
                    table[i * m + k][i * m + h] += block[k][h]
        return by_q, by_p

    def _pairs(self, q: Any, p: Any, pieces: Pieces) -> Iterator[tuple[int, int, Piece, list[Any], list[Any]]]:
        """Return (i, j, smooth piece, q_j − q_i, p_j − p_i) of every pair of agents in range."""
        pairs = zip(combinations(range(self.n), 2), pieces, strict=False)
        near_pairs = ((i, j, piece) for (i, j), piece in pairs if piece is not Piece.OUT)
        return ((i, j, piece, minus(q[j], q[i]), minus(p[j], p[i])) for i, j, piece in near_pairs)

    def _agents(self, pieces: Pieces) -> Iterator[tuple[int, int, Piece]]:
        """Return (index of the force, agent, smooth piece) wherever γ-agent or obstacles act on an agent."""
        agent_pieces = enumerate(pieces[self.n * (self.n - 1) // 2 :])
        return ((*divmod(k, self.n), piece) for k, piece in agent_pieces if piece is not Piece.OUT)

    def taylor(self, t: arb, state: Sequence[arb], order: int, pieces: Pieces) -> list[list[arb]]:
        """Return Taylor coefficients in time, up to `order`, of all solutions from a box of states."""
        half_dimension = self.n * self.m
        path = [[x] for x in state]
        for k in range(order):
            with series_length(k + 1):
                series = [arb_series(coefficients) for coefficients in path]
                u = self.input(arb_series([t, 1]), series, pieces)
            for x, v, a in zip(path[:half_dimension], path[half_dimension:], u, strict=True):
                x.append(v[k] / (k + 1))
                v.append(a[k] / (k + 1))
        return path

    def variation(self, t: arb, path: Sequence[Sequence[arb]], order: int, pieces: Pieces) -> list[arb_mat]:
        """Return Taylor coefficients, up to `order`, of the state transition matrix ∂x(t + s)/∂x(t)."""
        half_dimension = self.n * self.m
        with series_length(order):
            series = [arb_series(coefficients[:order]) for coefficients in path]
            by_q, by_p = self.slopes(arb_series([t, 1]), series, pieces)
            slopes = [(_coefficient(by_q, k), _coefficient(by_p, k)) for k in range(order)]
        rows = identity(2 * half_dimension).tolist()
        upper, lower = [arb_mat(rows[:half_dimension])], [arb_mat(rows[half_dimension:])]
        for k in range(order):
            rate = arb_mat(half_dimension, 2 * half_dimension)
            for j, (position_slope, velocity_slope) in enumerate(slopes[: k + 1]):
                rate += position_slope * upper[k - j] + velocity_slope * lower[k - j]
            upper.append(lower[k] * (arb(1) / (k + 1)))
            lower.append(rate * (arb(1) / (k + 1)))
        return [arb_mat(a.tolist() + b.tolist()) for a, b in zip(upper, lower, strict=True)]

    def rate(self, t: arb, state: Sequence[arb], pieces: Pieces) -> list[arb]:
        """Return the time derivative x' = (p, u) of the state on a box, across switching distances too."""
        return [*state[self.n * self.m :], *self.input(t, state, pieces)]

    def jacobian(self, t: arb, state: Sequence[arb], pieces: Pieces) -> arb_mat:
        """Return the Jacobian ∂(p, u)/∂(q, p) of the equations of motion on a box of states."""
        half = self.n * self.m
        by_q, by_p = self.slopes(t, state, pieces)
        return arb_mat(identity(2 * half).tolist()[half:] + [[*a, *b] for a, b in zip(by_q, by_p, strict=True)])

    def acceleration(self, t: arb, state: Sequence[arb], pieces: Pieces) -> list[arb]:
        """Return the second time derivative x'' of the state x = (q, p) on a box of states."""
        along = (self.jacobian(t, state, pieces) * column(self.rate(t, state, pieces))).entries()
        for term in self.terms:
            drift = [a for x in self.split(state)[0] for a in term.drift(t, x)]
            along[self.n * self.m :] = [a + b for a, b in zip(along[self.n * self.m :], drift, strict=True)]
        return along


def _couple(table: list[list[Any]], m: int, i: int, j: int, k: int, h: int, value: Any) -> None:
    """Add a pair's derivative by one coordinate of x_j − x_i to a Jacobian, with its reaction on j."""
    for row, partner, sign in ((i, j, 1), (j, i, 1), (i, i, -1), (j, j, -1)):
        table[row * m + k][partner * m + h] += value if sign > 0 else -value


def _coefficient(table: list[list[Any]], k: int) -> arb_mat:
    """Return the k-th coefficients of a table of series."""
    return arb_mat([[x[k] if isinstance(x, arb_series) else (x if k == 0 else 0) for x in row] for row in table])


def ensure_enclosable(law: Any) -> None:
    """Raise unless `enclose` supports a law."""
    if type(law) not in (Algorithm1, *_LED) or type(law.alpha) is not AlphaInteraction:
        raise ArgumentError(f"law = {format_value(law)}: expected Algorithm1, 2 or 3 with AlphaInteraction, unwrapped")
    if isinstance(law, _LED):
        ensure_one_gain(law.gains)
        if type(law.target) not in (StaticTarget, LinearTarget):
            raise ArgumentError(
                f"target = {law.target!r}: expected StaticTarget or LinearTarget, whose path is exact; under "
                "Algorithm 2 the shape moves alike with every target"
            )
    if isinstance(law, Algorithm3):
        for k, obstacle in enumerate(law.obstacles):
            if type(obstacle) is not Sphere:
                raise ArgumentError(f"obstacles[{k}] = {obstacle!r}: expected a Sphere, the one kind known in balls")


def flow_of(law: Any, n: int, m: int, *, number: Callable[[Any], fmpq] = exact) -> Flow:
    """Return the right-hand side, in ball arithmetic, of a law for n agents in m dimensions."""
    gains, alpha, target = law.gains, law.alpha, law.target
    terms: tuple[AgentTerm, ...] = ()
    rates = [gains.c2_alpha * min(n, 6), sqrt(gains.c1_alpha * n)]
    if isinstance(law, _LED):
        path = target.harmonic.terms
        unit = arb(number(alpha.unit)) if isinstance(law, Algorithm3) else None
        start, velocity, offset = (tuple(arb(number(x)) for x in path[k].tolist()) for k in (0, 1, 4))
        declared = tuple(a + b for a, b in zip(velocity, offset, strict=True))  # p_r = dq_r/dt + offset
        terms = (Pull(start, velocity, declared, arb(number(gains.c1_gamma)), arb(number(gains.c2_gamma)), unit),)
        rates += [gains.c2_gamma, sqrt(gains.c1_gamma)]
    if isinstance(law, Algorithm3) and law.obstacles:
        terms = (*terms, *sphere_terms(law, number))
        rates += [gains.c2_beta, sqrt(gains.c1_beta)]
    stiffness, damping = arb(number(gains.c1_alpha)), arb(number(gains.c2_alpha))
    return Flow(n, m, PairNumbers.of_alpha(law.alpha, number), stiffness, damping, max(rates) or 1.0, terms)


def sphere_terms(law: Any, number: Callable[[Any], fmpq] = exact) -> tuple[SphereTerm, ...]:
    """Return the forces of a law's spherical obstacles, in balls of the current precision."""
    gains: Any = law.gains
    beta, pull, drag = PairNumbers.of_beta(law.beta, number), arb(number(gains.c1_beta)), arb(number(gains.c2_beta))
    sphere_places = [(tuple(arb(number(y)) for y in one.centre), arb(number(one.radius))) for one in law.obstacles]
    return tuple(SphereTerm(beta, centre, radius, pull, drag) for centre, radius in sphere_places)
