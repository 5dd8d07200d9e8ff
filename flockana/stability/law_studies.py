"""Studies of a law near an equilibrium: linearised blocks, delays, periods, loops, norms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, Numbers, ensure_count, ensure_points
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import RESIDUAL, find_equilibrium
from flockana.lattice import hexagonal_spiral
from flockana.laws import Algorithm1, Algorithm2, DiscreteLaw, Law
from flockana.stability.cost_estimates import LIMIT
from flockana.stability.delay import DelaySystem, delayed_flock
from flockana.stability.delay_linearisation import DelayLinearisation
from flockana.stability.linearisation import Linearisation
from flockana.stability.linearise import linearise
from flockana.stability.norms import disturbance_system, h2_bounds, h2_norm, hinf_norm
from flockana.stability.robustness import RobustnessMargins, loop_margins
from flockana.stability.sampling import SamplingMargin, margin_of_flow
from flockana.stability.second_order_blocks import MOST, Blocks, blocks, ensure_pairs_and_pull

_LEAST = 1e-13  # of the stiffness of its agents: rounding of the sums in which it cancels


def delay_system(
    law: Any, q: Any, *, delayed: str = "all", carries: str = "both", links: Any = None, strict: bool = True
) -> DelaySystem:
    """Return the linearised flock of a law with delayed interactions.

    Parameters
    ----------
    law : Law
        A law that `linearise` takes.
    q : Equilibrium, Linearisation or array_like, shape (n, m)
        As for `linearise`.
    delayed : {"all", "pairs", "neighbours"}
        Everything, an agent's own state included; what depends on differences from other agents, its own state in them
        included; or only what it hears of other agents.
    carries : {"both", "positions", "velocities"}
        What is late of these.
    links : array_like, shape (M, 2), optional
        Pairs (i, j): only what agent i hears of agent j is late, of ``"pairs"`` or ``"neighbours"``; by default all.
    strict : bool
        Refuse a state that is no equilibrium.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> one = delay_system(Algorithm2(target=StaticTarget((0.0,))), [[0.0]])
    >>> [block.tolist() for block in one.late], one.neutral
    ([[[1.1]], [[2.0976176963403033]]], 0)
    """
    flock: Any = linearise(law, q, allow_residual=not strict)
    if isinstance(flock, DelayLinearisation):
        return flock.system
    if not isinstance(flock, Linearisation):
        kind = "is a map" if law.is_map else "is of first order"
        raise ArgumentError(f"{law.title} {kind}: expected a continuous law of second order; linearise(...) takes it")
    return delayed_flock(flock, delayed, carries, links)


def law_blocks(law: Any, q: Any, *, strict: bool = True) -> Blocks:
    """Return K and D of Algorithm 1 or 2 at an equilibrium, with classified rigid motions.

    K = c1α ∇²V + c1γ and D = c2α L̂ + c2γ, the gains of the γ-agent one for all or one per agent. Under Algorithm 2
    translations are held by c1γ; the rotation about the γ-agent is neutral at every equilibrium, because the stress
    of the pressed links cancels what c1γ holds.

    Parameters
    ----------
    q : Equilibrium or array_like, shape (n, m)
    strict : bool
        Refuse a state that is no equilibrium.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> from flockana.environment.targets import StaticTarget
    >>> one = law_blocks(Algorithm2(target=StaticTarget((0.0,))), [[0.0]])
    >>> one.stiffness.tolist(), one.neutral.shape
    ([[1.1]], (1, 0))
    """
    q = ensure_points("q", getattr(q, "q", q))
    ensure_pairs_and_pull(law)
    law.check_dimension(q.shape[1])
    law.check_agents(len(q))
    if q.size > MOST:
        raise ArgumentError(
            f"n m = {q.size}: expected at most {MOST} for a dense spectrum; linearise has sparse matrices"
        )
    if strict and (residual := Potential(law).residual(q)) > RESIDUAL:
        raise ArgumentError(
            f"q is no equilibrium: residual force {residual:.2g} of the law's force scale, more than {RESIDUAL:g}; "
            "find_equilibrium finds one, and strict=False studies this state all the same"
        )
    linearised = linearise(law, q, allow_residual=True)
    return blocks(linearised.stiffness.toarray(), linearised.damping.toarray(), q, zero=max(linearised.zero, _LEAST))


def robustness_margins(law: Law, equilibrium: Any, *, limit: float = LIMIT) -> RobustnessMargins:
    """Return gain, phase and disk margins and sensitivity peaks of the loops broken at each agent's input.

    Parameters
    ----------
    law : Law
        A law that `linearise` takes.
    equilibrium : Equilibrium or array_like, shape (n, m)
        As for `linearise`.
    limit : float
        Seconds of estimated work from which on it is refused.

    Raises
    ------
    ArgumentError
        If the flock is not stable or the work would take longer than the limit, or on what `linearise` refuses.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=4.0), target=StaticTarget((0.0,)))
    >>> found = robustness_margins(law, [[0.0]])
    >>> found.gain, round(found.phase, 2)
    ((0.0, inf), 76.35)
    """
    return loop_margins(linearise(law, equilibrium), limit)


def sampling_margin(law: Any, equilibrium: Any, *, limit: float = LIMIT) -> SamplingMargin:
    """Return the largest sampling period, or step of a map, for which a flock is stable near its equilibrium.

    Parameters
    ----------
    law : Law or DiscreteLaw
        A continuous law, under a zero-order hold; or a map that steps one, whatever its own step.
    equilibrium : Equilibrium or array_like, shape (n, m)
        As for `linearise`.
    limit : float
        Seconds of estimated work from which on it is refused: intervals of steps are certified by dense matrices of
        four times as many rows as there are states, 19 agents in seconds, 300 in a day.

    Raises
    ------
    ArgumentError
        On what `linearise` refuses, or if the work would take longer than the limit.

    Examples
    --------
    One agent at its γ-agent, c1γ = 4 and c2γ = 1, is held stable for periods below 2 c2γ/c1γ:

    >>> from flockana import ExplicitEuler, Gains, StaticTarget
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> one = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=1.0), target=StaticTarget((0.0,)))
    >>> sampling_margin(one, [[0.0]]).period, sampling_margin(ExplicitEuler(one, 0.1), [[0.0]]).period
    (0.5, 0.25)
    """
    name, factor, is_in_place = "hold", 0.5, False
    if isinstance(law, DiscreteLaw):
        if law.continuous is None or law.position_factor is None:
            raise ArgumentError(f"{type(law).__name__} steps no law: expected a law, or a map that steps one")
        name, factor, is_in_place = law.title, law.position_factor, law.in_place
        law = law.continuous
    flow = linearise(law, equilibrium)
    return margin_of_flow(name, flow, factor, in_place=is_in_place, limit=limit)


@dataclass(frozen=True)
class NormTable:
    """Norms of relaxed hexagonal flocks against their size."""

    sizes: tuple[int, ...]
    h2: FloatArray  # h2, hinf: shape (N,): norms from a force on each agent to the shape, in length over force
    hinf: FloatArray
    peak: FloatArray  # shape (N,): frequency of the largest gain, in radians per time unit
    bounds: FloatArray  # shape (N, 2): closed-form bounds of `h2`


@check_kinds
def norms_against_size(law: Algorithm1 | Algorithm2, sizes: Numbers) -> NormTable:
    """Return the H₂ and H∞ norms of relaxed hexagonal spirals of given sizes in the plane.

    Parameters
    ----------
    law : Algorithm1 or Algorithm2
        The law, with one gain for all.
    sizes : sequence of int
        Numbers of agents.

    Examples
    --------
    >>> table = norms_against_size(Algorithm1(), [3, 7])
    >>> bool(table.h2[1] > table.h2[0] and np.all(table.bounds[:, 0] <= table.h2))
    True
    """
    ensure_pairs_and_pull(law)
    counts = tuple(ensure_count("sizes", n) for n in sizes)
    alpha: Any = law.alpha
    rows = []
    for n in counts:
        flock = law_blocks(law, find_equilibrium(law, hexagonal_spiral(n, alpha.d)).q)
        system = disturbance_system(flock)
        rows.append((h2_norm(system), *hinf_norm(system), *h2_bounds(flock)))
    table = np.array(rows).reshape(-1, 5)
    return NormTable(counts, table[:, 0], table[:, 1], table[:, 2], table[:, 3:])
