"""Linearisation of a law or a map about a verified equilibrium."""

from __future__ import annotations

from dataclasses import replace
from math import inf, sqrt
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack, get_args, overload

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import (
    FloatArray,
    ensure_finite_scalar,
    ensure_flag,
    ensure_known,
    ensure_links,
    ensure_points,
    ensure_positive,
    ensure_state,
)
from flockana.equilibria.solve import Equilibrium, ensure_unedited_equilibrium
from flockana.laws import Delayed, DiscreteLaw, Law, Sampled, ensure_law
from flockana.laws.first_order_law import VelocityLaw, first_order
from flockana.laws.wrapper_base import needs_steps
from flockana.measures.centre_frame import moving_frame
from flockana.measures.nets import links as links_within
from flockana.solvers.taylor_step import TaylorStep
from flockana.stability.delay_linearisation import DelayLinearisation
from flockana.stability.first_order import VelocityLinearisation, linearise_velocity
from flockana.stability.lifted_loops import lifted_map
from flockana.stability.linearisation import Linearisation
from flockana.stability.map_linearisation import MapLinearisation, linearise_headings, linearise_map, linearise_steps
from flockana.stability.wrapped_loops import hold_of, instant_law, is_late, late_parts
from flockana.stability.zero_modes import extent, zero_threshold

if TYPE_CHECKING:
    from scipy.sparse import csr_array

RESIDUAL = 1e-9  # of the force scale: what counts as an equilibrium, as in `flockana.equilibria`
_LATER = 0.7310585786  # of the flock's own time: after it a steady motion must still have the same Jacobian
_STEADY = 1e-9  # relative
Side = Literal["inner", "outer"]
SIDES = get_args(Side)
_CORNER, _BESIDE = 1e-10, 2e-10  # relative: how near to a kink a pair is at it, and where the law is taken beside it
_FEIGNED = 1e-6  # residual that a step aside may leave


class _Options(TypedDict, total=False):
    """Keyword arguments of `linearise`."""

    t: float
    links: Any
    force_tolerance: float
    allow_residual: bool
    zero: float | None
    side: Side | None


@overload
def linearise(
    law: DiscreteLaw | Sampled, equilibrium: Any, p: Any = ..., **how: Unpack[_Options]
) -> MapLinearisation: ...
@overload
def linearise(law: VelocityLaw, equilibrium: Any, p: Any = ..., **how: Unpack[_Options]) -> VelocityLinearisation: ...
@overload
def linearise(law: Delayed, equilibrium: Any, p: Any = ..., **how: Unpack[_Options]) -> DelayLinearisation: ...
@overload
def linearise(law: Any, equilibrium: Any, p: Any = ..., **how: Unpack[_Options]) -> Linearisation: ...
def linearise(
    law: Any,
    equilibrium: Any,
    p: Any = None,
    *,
    t: float = 0.0,
    links: Any = None,
    force_tolerance: float = RESIDUAL,
    allow_residual: bool = False,
    zero: float | None = None,
    side: Side | None = None,
) -> Linearisation | MapLinearisation | DelayLinearisation | VelocityLinearisation:
    """Linearise a law or a map about an equilibrium, after verifying the equilibrium.

    Under Algorithms 1 and 2 (with one gain for all) that is the frame of the centre of mass: it is exact for every
    motion of the γ-agent, for the Jacobian depends on differences of positions alone, and the centre obeys the same
    linear equation wherever it is. Then only the shape must be at equilibrium. Under any other law all agents must keep
    one constant velocity with no force on them, along which the Jacobian must not change. A map that steps such a law
    rests where the law does; a map of headings is linearised about parallel motion, `p`, and any other map where it is
    smooth about a motion that it keeps, by differences of its steps.

    Of a wrapped law the loop is linearised: within its limits where it is `Saturated`, without its noise where it is
    `Measured` or `Disturbed`, in the mean where it is `Lossy`, with its past where it is `Delayed`, and over a period
    where it is `Sampled`. A `VelocityLaw` has n·m poles, at positions where its velocities are 0.

    Parameters
    ----------
    law : Law, VelocityLaw or DiscreteLaw
        Any continuous law, wrapped or not (a law of your own without `derivatives` is differentiated by differences);
        or a map: a scheme such as `TaylorStep`, the MSN project's, the minimal model's, `HeadingAveraging`,
        `ZoneFlocking`.
    equilibrium : Equilibrium or array_like, shape (n, m)
        From `find_equilibrium`, or positions. A linearisation of this law is returned as it is.
    p : array_like, shape (n, m), optional
        Velocities; by default those of the γ-agent, else zero.
    t : float
        When, for a law that depends on time.
    links : array_like, shape (M, 2), optional
        Links whose lengths are outputs; by default those of the equilibrium, or pairs within the law's range.
    force_tolerance : float
        Largest residual. It is the largest force on an agent over that of the law's `scales` (of a law without: over
        the largest entry of ∂u/∂q times the size of the flock), or the largest relative velocity over that force times
        the length (or size), square root taken, whichever is larger.
    allow_residual : bool
        Linearise about a state that is no equilibrium as if it stood still.
    zero : float, optional
        See `Linearisation`; by default what rounding and the force left here may feign, at most 1e-8, or what takes in
        the soft modes that an `Equilibrium` tells of (a link that lets go at r is as stiff as the solver left it).
    side : {"inner", "outer"}, optional
        Where pairs stand at a kink or a jump of the law, of which there is no linearisation: take the force as it is
        just inside that distance, or just outside. By default that is refused.

    Returns
    -------
    Linearisation; of a map or a `Sampled` law MapLinearisation, of a `Delayed` one DelayLinearisation, of a
    `VelocityLaw` VelocityLinearisation

    Raises
    ------
    ArgumentError
        If the state is no equilibrium, the law has no Jacobian there or not one (a pair at a kink or a jump), or an
        argument is bad.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> from flockana.environment.targets import StaticTarget
    >>> law = Algorithm2(target=StaticTarget((0.0,)))
    >>> one = linearise(law, [[0.0]])
    >>> [round(value.real, 6) for value in one.eigenvalues.tolist()] == [-1.048809, -1.048809]
    True
    """
    how = {"t": t, "force_tolerance": force_tolerance, "allow_residual": allow_residual, "zero": zero, "side": side}
    if (
        isinstance(equilibrium, (Linearisation, MapLinearisation, DelayLinearisation, VelocityLinearisation))
        and equilibrium.law is law
    ):
        return equilibrium
    if isinstance(law, VelocityLaw):
        if any(item is not None for item in (links, zero, side)):
            raise ArgumentError(f"links, zero, side: {law.title} is of first order; expected None")
        q, t = _positions(law, equilibrium), ensure_finite_scalar("t", t)
        return linearise_velocity(law, (t, q, p), force_tolerance, allow_residual)
    if isinstance(ensure_law(law), DiscreteLaw):
        return _linearised_map(law, equilibrium, p, how)
    if needs_steps(law):
        if first_order(law) is not None:
            raise ArgumentError(
                f"{law.title} is around a law of first order: expected that law itself; linearise(...).delay_margin() "
                "and .sampling_margin() tell what delay and period it bears"
            )
        return _linearised_loop(law, equilibrium, p, how | {"links": links})
    if isinstance(equilibrium, Equilibrium):
        ensure_unedited_equilibrium("equilibrium", equilibrium)
    q, t = _positions(law, equilibrium), ensure_finite_scalar("t", t)
    if p is None:
        p = np.zeros_like(q) if law.target is None else np.tile(law.target.rate(t), (len(q), 1))
    q, p = ensure_state(q, p)
    at, slack = _on_side(law, q, side)
    ensure_flag("allow_residual", allow_residual)
    tolerance = ensure_positive("force_tolerance", force_tolerance)
    matrix = _finite_jacobian(law, t, at, p)
    zero = _zero_threshold(law, equilibrium, t, at, p, matrix) if zero is None else ensure_positive("zero", zero)
    residual = _residual(law, t, at, p, matrix)
    if not residual <= max(tolerance, slack) and not allow_residual:
        raise ArgumentError(
            f"the state is no equilibrium of {law.title}: its residual is {residual:.3g}, expected at most "
            f"{tolerance:g}; start from find_equilibrium(...), or ask for allow_residual=True"
        )
    if not allow_residual:
        _ensure_steady(law, t, at, p, matrix)
    if links is None:  # pairs within the law's interaction range, if it has one
        links = links_within(q, law.pair.range) if law.pair else ()
        links = getattr(equilibrium, "links", links)
    link_array = ensure_links(links, len(q))
    q, p = q.copy(), p.copy()
    q.flags.writeable = p.flags.writeable = False
    return Linearisation(law, q, p, t, residual, link_array, matrix, zero)


def _linearised_map(law: DiscreteLaw, equilibrium: Any, p: Any, how: dict[str, Any]) -> MapLinearisation:
    """Linearise a map: by its continuous law, or by the mean of headings."""
    if law.continuous is not None and (law.position_factor is not None or law.stability_function is not None):
        flow: Any = linearise(law.continuous, equilibrium, p, **how)
        if not isinstance(flow, Linearisation):
            raise ArgumentError(
                f"{law.title} steps a law with a past or a clock: expected a law without, or Sampled(law, "
                "period) around one that is Delayed, whose map linearise(...) gives"
            )
        return linearise_map(law, flow)
    q = _positions(law, equilibrium)
    q, p = ensure_state(q, np.zeros_like(q) if p is None else p)
    law.check_start(q, p)
    has_headings = q.shape[1] == 2 and law.averaging_matrix(q, np.arctan2(p[:, 1], p[:, 0])) is not None
    ways = linearise_headings if has_headings else linearise_steps
    return ways(law, q, p, ensure_finite_scalar("t", how["t"]))


def _linearised_loop(
    law: Law, equilibrium: Any, p: Any, how: dict[str, Any]
) -> Linearisation | MapLinearisation | DelayLinearisation:
    """Linearise a wrapped law with delay, clock or random loss about a rest of the inner law."""
    from scipy.sparse import block_array, csr_array, eye_array

    hold, acting = hold_of(law), instant_law(law)
    flow = linearise(acting, equilibrium, p, **how)
    law.check_agents(len(flow.q))
    parts = late_parts(law, (flow.t, _on_side(acting, flow.q, how["side"])[0], flow.p))
    matrices: Any = [csr_array(-np.sum(item, axis=0)) for item in zip(*(part[1:] for part in parts), strict=True)]
    full_matrix: Any = block_array([[None, eye_array(flow.q.size)], matrices], format="csr")
    flow = replace(flow, law=law, A_sparse=csr_array(full_matrix))
    if hold is not None and (is_late(law) or hold.offsets is not None):
        return lifted_map(law, flow, parts, hold)
    if hold is not None:
        return replace(linearise_map(TaylorStep(instant_law(law), hold.period), flow), law=law, step=hold.period)
    return DelayLinearisation(law, flow, tuple(parts)) if is_late(law) else flow


def _positions(law: Any, equilibrium: Any) -> FloatArray:
    q = ensure_points("equilibrium", getattr(equilibrium, "q", equilibrium))
    law.check_dimension(q.shape[1])
    return q


def _zero_threshold(law: Law, equilibrium: Any, t: float, q: FloatArray, p: FloatArray, matrix: csr_array) -> float:
    """Return the stiffness threshold of zero modes: rounding, residual force, known soft modes."""
    half, scales = q.size, law.scales
    stiffness, force = -matrix[half:, :half], law.flow(t, q, p)[0]
    force = moving_frame(force) if law.centre_decouples else force
    length_scale = scales.length if scales else extent(q)
    zero = zero_threshold(stiffness, force, length_scale)
    magnitudes = np.sort(np.abs(getattr(equilibrium, "hessian_eigenvalues", np.zeros(0))))
    soft, row = getattr(equilibrium, "zero_modes", 0), float(abs(stiffness).sum(axis=1).max())
    if soft == 0 or row == 0.0 or (soft < magnitudes.size and 2.0 * magnitudes[soft - 1] >= magnitudes[soft]):
        return zero
    return max(zero, 2.0 * float(magnitudes[soft - 1]) / row)


def _on_side(law: Law, q: FloatArray, side: Side | None) -> tuple[FloatArray, float]:
    """Return positions at which the law is smooth, and the resulting residual; raise without a side."""
    # velocities are equal: a kink of the adjacency, whose value alone counts, is none of the linear flock
    corners = [one for one in law.corners_at(q, _CORNER) if (one.corner.part, one.corner.kind) != ("adjacency", "kink")]
    if side is not None:
        ensure_known("side", side, SIDES)
    if not corners:
        return q, 0.0
    if side is None:
        first, more = corners[0], f", and {len(corners) - 1} more" if len(corners) > 1 else ""
        raise ArgumentError(
            f"agents {first.i} and {first.j} are {first.distance:.9g} apart, where {first.name} has no slope "
            f"({first.corner}){more}: expected pairs within the pieces of the law; "
            'side="inner" or side="outer" takes the law as it is just inside or outside'
        )
    centre = q.mean(axis=0)
    return centre + (1.0 + (_BESIDE if side == "outer" else -_BESIDE)) * (q - centre), _FEIGNED


def _finite_jacobian(law: Law, t: float, q: FloatArray, p: FloatArray) -> csr_array:
    matrix = law.jacobian(t, q, p, sparse=True)
    if np.isfinite(matrix.data).all():
        return matrix  # type: ignore[return-value]  # sparse was asked for
    from scipy.spatial import cKDTree

    why = ""
    if len(q) > 1:
        nearest: Any = cKDTree(q).query(q, k=2)
        distance, other = nearest
        i = int(np.argmin(distance[:, 1]))
        j = other[i, 1] if other[i, 1] != i else other[i, 0]  # of coincident agents either may come first
        why = f", where agents {min(i, j)} and {max(i, j)} are {distance[i, 1]:.3g} apart"
    raise ArgumentError(
        f"{law.title} has no Jacobian at this state{why}: expected distinct agents, none at the centre of an obstacle"
    )


def _residual(law: Law, t: float, q: FloatArray, p: FloatArray, matrix: csr_array) -> float:
    """Return the largest force and relative velocity, over the law's own scales."""
    force = law.flow(t, q, p)[0]
    if law.centre_decouples:
        force = moving_frame(force)
    if law.scales is not None:
        length, scale = law.scales.length, law.scales.force
    else:
        length = extent(q)
        scale = float(abs(matrix[q.size :, : q.size]).max()) * length
    strongest, fastest = (float(np.linalg.norm(x, axis=1).max()) for x in (force, moving_frame(p)))
    with np.errstate(divide="ignore", invalid="ignore"):  # without a scale, infinite unless nothing is left
        return float(np.nan_to_num(np.divide((strongest, fastest), (scale, sqrt(scale * length))), posinf=inf).max())


def _ensure_steady(law: Law, t: float, q: FloatArray, p: FloatArray, matrix: csr_array) -> None:
    """Raise if the Jacobian changes along the steady motion, which would make the system time-varying."""
    # Looked at after a little less than one, ten and a hundred of the flock's own times, that of its stiffest motion.
    if law.centre_decouples:
        return
    size = q.size
    stiff, drag = (float(abs(matrix[size:, columns]).max()) for columns in (slice(0, size), slice(size, None)))
    time_scale = 1.0 / max(sqrt(stiff), drag) if stiff or drag else 1.0
    for later_time in (_LATER * time_scale, 10.0 * _LATER * time_scale, 100.0 * _LATER * time_scale):
        drift = law.jacobian(t + later_time, q + later_time * p, p, sparse=True) - matrix
        changes = (abs(drift[size:, columns]).max() for columns in (slice(0, size), slice(size, None)))
        if any(change > _STEADY * scale for change, scale in zip(changes, (stiff, drag), strict=True)):
            raise ArgumentError(
                f"the Jacobian of {law.title} changes along the motion of this state (within {later_time:.2g} "
                "time units): expected a γ-agent that rests or moves steadily, no obstacles where it moves; "
                "allow_residual=True linearises at the instant"
            )
