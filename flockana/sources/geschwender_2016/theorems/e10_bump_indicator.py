"""Erratum E10: at h = 1 the bump function is an indicator, and no longer continuous."""

from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact


@erratum("E10")
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides say that with h = 1 the bump becomes an indicator function and stays differentiable."""
    # One-sided limits at the end of the bump, by sympy: for every h < 1, and for h = 1.
    import sympy as sp

    from flockana.symbolic import bump
    from flockana.symbolic.scalar_functions import taper

    z, h = sp.Symbol("z", positive=True), sp.Symbol("h", positive=True)
    indicator = bump(z, h=sp.Integer(1))
    offset = sp.Symbol("t", positive=True)  # constant on either side, so its values there are the one-sided limits
    jump = indicator.subs(z, 1 - offset) - indicator.subs(z, 1 + offset)
    falling_bump = taper(z, h=h)
    end_values = [sp.simplify(f.subs(z, end)) for end in (h, 1) for f in (falling_bump, falling_bump.diff(z))]
    return [
        exact("printed", jump == 0, disproof="smoothness", computed=f"ρ₁(1⁻) - ρ₁(1⁺) = {jump}").described(
            stated="differentiable at h = 1", witness="z = 1", detail=f"at h = 1 the function jumps by {jump} at z = 1"
        ),
        exact("corrected", end_values == [1, 0, 0, 0], proof="smoothness").described(
            computed="ρ_h(h) = {}, ρ_h'(h) = {}, ρ_h(1) = {}, ρ_h'(1) = {}".format(*end_values),
            stated="C¹ for every 0 < h < 1",
            witness="both ends of the taper",
            detail="for 0 < h < 1 value and slope match at both ends of the taper",
        ),
    ]
