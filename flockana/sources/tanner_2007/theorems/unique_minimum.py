"""Erratum: a flock's limit is a critical point of each agent's potential, not always a minimum."""

from typing import Any

from flockana.theorems.theorem_toolkit import Claim, Tolerances, equal, erratum, exact


def _own_block() -> Any:
    """Return one agent's Hessian block of the total potential minus that of the agent's own potential."""
    import sympy as sp

    V, agent_symbols = sp.Function("V"), [sp.symbols(f"x{i} y{i}", real=True) for i in range(3)]

    def pair(i: int, j: int) -> Any:
        return V(sp.sqrt(sum((a - b) ** 2 for a, b in zip(agent_symbols[i], agent_symbols[j], strict=True))))

    own_block = pair(0, 1) + pair(0, 2)
    total = own_block + pair(1, 2)
    return [sp.simplify(sp.diff(total - own_block, a, b)) for a in agent_symbols[0] for b in agent_symbols[0]]


@erratum(
    "tanner-minimum",
    references=("tanner-2007", "flockana"),
    expected={"refuted": "printed", "verified": "corrected second-order"},
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The theorem on fixed networks says that the flock approaches a state that minimises the potentials of all agents.
    Its proof shows that no force acts in the limit. Three agents at rest on a line, all joined and √3/2 d apart, stay
    there, and the potential of the one in the middle falls to either side. But that state is unstable: at a minimum of
    the total energy each agent's own potential is least to second order, so that the printed claim fails for a thin set
    of starts. With many links agents are off the minima of single pairs even in a stable limit.
    """
    # Three agents, all joined, at rest on a line at spacing √3/2 d: no force acts, and the middle is on a hill.
    import sympy as sp

    s, y = sp.symbols("s y", positive=True)
    potential = 1 / s**2 - 1 + sp.log(s**2)  # d = k = 1
    slope, spacing = sp.diff(potential, s), sp.sqrt(3) / 2
    outer = sp.simplify(slope.subs(s, spacing) + slope.subs(s, 2 * spacing))
    energy_on_axis = 2 * potential.subs(s, sp.sqrt(spacing**2 + y**2))
    hill = sp.simplify(sp.limit(sp.diff(energy_on_axis, y, 2), y, 0))
    return [
        exact("printed", bool(hill >= 0), computed=str(hill)).described(
            stated="the potentials of all agents are minimised",
            witness="three agents, all joined, at rest on a line, √3/2 d apart",
            detail=f"the second derivative of the middle agent's potential to the side is {hill} k/d² < 0; the total "
            "falls there as well, so that all but a thin set of starts leave",
        ),
        equal("corrected", outer, stated="the total potential is extremal", detail="no force acts on any agent"),
        equal("second-order", _own_block()).described(
            stated="at a minimum of the total no second derivative of an agent's own potential is negative",
            detail="along one agent the total and its own potential have the same second derivatives, for every pair "
            "potential: where the total is least each agent's own is, to second order",
        ),
    ]
