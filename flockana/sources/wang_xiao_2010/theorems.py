"""Wang and Xiao (2010): velocities on a connected undirected net agree by a time bounded through λ₂."""

import numpy as np

from flockana.sources.wang_xiao_2010.laws import FiniteTimeAlignment
from flockana.theorems.theorem import Checked, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, judged, law_is, run_theorem, vacuous

_PROOF = "finite-time"


def _connected(law: FiniteTimeAlignment, n: int) -> Hypothesis:
    """Return the hypothesis that the net is connected."""
    import networkx

    net = networkx.Graph(law.links)
    net.add_nodes_from(range(n))
    groups = networkx.number_connected_components(net)
    text = f"{groups} component{'s' * (groups > 1)}"
    return condition("the net is connected", groups == 1, detail=text, remedy="add links between components")


def _rate(law: FiniteTimeAlignment, n: int) -> Enclosure:
    """Return κ = λ₂^((1+α)/2), with λ₂ of the Laplacian with weights b^(2/(1+α)), b = a s^(1−α)."""
    power, laplacian = 0.5 * (1.0 + law.exponent), np.zeros((n, n))
    for i, j in law.links:
        laplacian[i, j] = laplacian[j, i] = -1.0
    laplacian -= np.diag(laplacian.sum(axis=1))
    eigenvalues = np.linalg.eigvalsh(laplacian)
    rate = Enclosure.around(float(eigenvalues[1]), 16.0 * n * EPS * float(eigenvalues[-1]))
    factor = law.gain * law.speed ** (1.0 - law.exponent)  # (b^(1/power))^power
    return rate.rising(lambda value: np.maximum(value, 0.0) ** power).scaled_out(16.0 * EPS) * factor


@run_theorem(
    "finite-time",
    title="By powers below 1 of their differences velocities over a connected net agree in a finite time",
    source="Wang and Xiao 2010, of velocities, in our words; some-start ours",
    law=law_is("alignment by powers of differences", FiniteTimeAlignment),
    claims=("bound", "settle", "some-start"),
    ours=("some-start",),
    references=("wang-xiao-2010", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let u_i = b Σ_j sig(p_j - p_i)^α over the links of a connected undirected net, b = a s^(1-α), 0 < α < 1, and v² =
    Σ‖p_i - p̄‖². Then v^(1-α) <= v(0)^(1-α) - κ(1-α)t with κ = λ₂^((1+α)/2), λ₂ the second eigenvalue of the Laplacian
    with the weights b^(2/(1+α)): all velocities are p̄ from T = v(0)^(1-α)/(κ(1-α)) on, which two agents on a line
    attain. For α = 1, or if the net is not connected, from some start they never agree.
    """
    law: FiniteTimeAlignment = seen.law
    alpha = law.exponent
    count_claim = condition("two agents or more", seen.n > 1, detail=f"n = {seen.n}")
    root = condition("α < 1", alpha < 1.0, 1.0 - alpha, f"α = {alpha:g}", remedy="lower α below 1")
    net = _connected(law, seen.n)
    needs = [count_claim, root, net]
    if unmet([count_claim]):
        return needs, []
    missed = unmet([root, net])
    if missed is not None:
        negation = Hypothesis(f"not: {missed.name}", "met", detail=missed.detail)
        never_claim = judged("some-start", Enclosure.of(0.0), [count_claim, negation], about="all", proof=_PROOF)
        return needs, [never_claim.described(stated="from some start velocities never agree", detail=missed.detail)]
    rest, rate, v = 1.0 - alpha, _rate(law, seen.n), seen.velocity_spread
    level, fall_rate = v.rising(lambda value: value**rest), rest * rate
    start, t = level[0], seen.t - seen.t[0]
    end_time = start / fall_rate
    margin = (start - fall_rate * t).clip(0.0) - level
    k = int((level.mid - (start.mid - fall_rate.mid * t)).argmax())
    text = f"v goes from {v.mid[0]:.6g} to {v.mid[-1]:.3g} at t = {seen.t[-1]:.6g}"
    return needs, [
        judged("bound", margin, needs, proof=_PROOF, computed=float(v.mid[k])).described(
            stated=f"v^{rest:.3g} <= {start.mid:.6g} - {fall_rate.mid:.6g} t",
            witness={"time": float(seen.t[k])},
            detail=text,
        ),
        judged("settle", Enclosure.of(0.0), needs, about="all", proof=_PROOF).described(
            computed=float(v.mid[-1]), stated=f"all velocities are p̄ from T = {end_time.mid:.6g} on", detail=text
        ),
        vacuous("some-start", condition("α >= 1 or the net is not connected", False, -rest, f"α = {alpha:g}")),
    ]
