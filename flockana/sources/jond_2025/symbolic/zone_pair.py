"""Zone-based flocking of one pair in sympy: both forms of the behaviours, bounds, rest distances.

Equation numbers are those of Jond's paper. A sum over a zone is a sum of these pairs, divided by the sum of the
weights where the behaviour is a mean, so that a pair shows the equality of the two forms for every number of agents.
"""

import sympy as sp

from flockana.base.value_checks import ensure_dimension
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.generic_pair import vector
from flockana.symbolic.parameter_symbols import exact

C, GAIN, STEP = sp.symbols("c w delta", positive=True)
SPEED, BOUND = sp.symbols("v^d m", positive=True)
PULL, LEAST, DRIVE = sp.symbols("g r w^ga", positive=True)
OWN = sp.Symbol("v", real=True)  # of an agent on a line
_X = sp.Symbol("x", nonnegative=True)


def pair_symbols(m: int = 2) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix, sp.Matrix]:
    """Return (p_i, v_i, p_j, v_j): positions and velocities of an agent and a neighbour."""
    return tuple(vector(name, ensure_dimension(m)) for name in ("p_i", "v_i", "p_j", "v_j"))


def bearing(m: int = 2) -> tuple[sp.Expr, sp.Matrix, sp.Expr, sp.Matrix]:
    """Return (d, b, d', b'): distance and bearing (11) from i to j, and their rates by the chain rule (12)."""
    p_i, v_i, p_j, v_j = pair_symbols(m)
    gap = p_j - p_i
    d = sp.sqrt(gap.dot(gap))
    b = gap / d
    flow = list(zip([*p_i, *p_j], [*v_i, *v_j], strict=True))
    d_rate, *b_rate = (sp.Add(*(item.diff(x) * v for x, v in flow)) for item in (d, *b))
    return d, b, d_rate, sp.Matrix(b_rate)


def position_form(m: int = 2) -> dict[str, sp.Matrix]:
    """Return cohesion (3), alignment (4) and separation (6) of a pair with unit weights, from positions."""
    p_i, v_i, p_j, v_j = pair_symbols(m)
    d = sp.sqrt((p_j - p_i).dot(p_j - p_i))
    return {"cohesion": p_j - p_i, "alignment": v_j - v_i, "separation": (1 - C / d) * (p_j - p_i)}


def bearing_form(m: int = 2) -> dict[str, sp.Matrix]:
    """Return cohesion (14), alignment (15) and separation (19) of a unit-weight pair, from bearing and distance."""
    d, b, d_rate, b_rate = bearing(m)
    return {"cohesion": d * b, "alignment": d * b_rate + d_rate * b, "separation": (d - C) * b}


def derive_equivalence(m: int = 2) -> Derivation:
    """Derive that position and bearing forms agree for cohesion, alignment (identity (13)) and separation."""
    left, right = bearing_form(m), position_form(m)
    residuals = tuple(sp.simplify(a - b) for name in left for a, b in zip(left[name], right[name], strict=True))
    d, b, d_rate, b_rate, v_i, v_j = sp.symbols("d_ij b_ij d'_ij b'_ij v_i v_j")
    steps = (
        Step("The rates of distance and bearing by the chain rule.", sp.Eq(d * b_rate + d_rate * b, v_j - v_i)),
        Step("Both forms of cohesion and of separation.", sp.Eq((d - C) * b, (1 - C / d) * d * b), d > 0),
    )
    return Derivation("Position form and bearing-distance form", steps, sp.Integer(0), residuals)


def estimate_gap() -> sp.Expr:
    """Return the error v − v̂ of velocity estimate (17) one step after v̂ = v: δ u^ga unsaturated."""
    # (17) adds δ u^aux, the input without the global speed term: Remark 3's equivalence fails (J8)
    aux = sp.Symbol("u^aux", real=True)
    drive_force = GAIN * (SPEED * sp.sign(OWN) - OWN)
    return sp.factor(sp.expand(OWN + STEP * (aux + drive_force) - (OWN + STEP * aux)), STEP, GAIN)


def saturation(norm: sp.Expr = _X, *, bound: sp.Expr = BOUND) -> sp.Expr:
    """Return m tanh(x/m), the length that (9) and (10) give to a vector of length x."""
    bound = exact("bound", bound)
    return bound * sp.tanh(exact("norm", norm) / bound)


def fastest_under_drag(step: sp.Expr, force: sp.Expr, bound: sp.Expr, *, digits: int = 15) -> sp.Float:
    """Return lim sup ‖v‖ under (10) for inputs up to `force`: the fixed point of v ↦ sat(v + δ u)."""
    v = sp.Symbol("v", positive=True)
    delta, u, m = (exact(name, x) for name, x in (("step", step), ("force", force), ("bound", bound)))
    return sp.nsolve(saturation(v + delta * u, bound=m) - v, v, m / 2, prec=digits)


def stand_off(*, desired_speed: sp.Expr = SPEED, drive: sp.Expr = DRIVE, weight: sp.Expr = GAIN) -> sp.Expr:
    """Return the distance at which an agent that heads for a wall stands: global drive and repulsion balance (J12)."""
    d = sp.Symbol("d", real=True)
    balance = exact("drive", drive) * exact("v^d", desired_speed) + exact("weight", weight) * (d - C)
    return sp.expand(sp.solve(balance, d)[0])


def rest_distance(*, separation: sp.Expr = GAIN, cohesion: sp.Expr = PULL, repulsion: sp.Expr = LEAST) -> sp.Expr:
    """Return the distance of a pair at rest: where separation and cohesion balance, but no less than r (J15)."""
    # cohesion is off at r and nearer: where the balance would be there, the pair slides at r
    d = sp.Symbol("d", positive=True)
    balance = exact("separation", separation) * (d - C) + exact("cohesion", cohesion) * d
    return sp.Max(exact("repulsion", repulsion), sp.factor(sp.solve(balance, d)[0]))


def altitude(speed: sp.Expr | None = None) -> sp.Expr:
    """Return the altitude of an obstacle zone that goes from r at rest to a at the greatest speed m (J13)."""
    r, a = LEAST, sp.Symbol("a", positive=True)
    v = sp.Symbol("v", nonnegative=True) if speed is None else exact("speed", speed)
    return sp.expand(r + (a - r) * sp.Min(1, v / BOUND))


def informed_pair() -> tuple[sp.Matrix, sp.Expr]:
    """Return (M, characteristic polynomial) of x' = M x, a pair's speeds less v^d with one informed agent.

    g is the gain of alignment, w that of the desired speed. All coefficients are positive: both take over v^d (J14).
    """
    g, rate = PULL, sp.Symbol("lambda")
    matrix = sp.Matrix([[-g - GAIN, g], [g, -g]])
    return matrix, sp.collect(sp.expand(matrix.charpoly(rate).as_expr()), rate)
