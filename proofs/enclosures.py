"""Enclosures to 30 digits of the constants of every scenario's interaction, which the compiled kernels must meet."""

from __future__ import annotations

from collections.abc import Iterator

from flint import arb, ctx

from flockana.certified.balls import AlphaParameters, BetaParameters
from flockana.certified.decimal_rounding import plus_minus, small
from flockana.certified.scalar_functions_in_balls import c_star, d_alpha, d_beta, far_potential, psi_beta, r_alpha
from flockana.scenarios import scenario, scenarios
from proofs.proof import Proof, Step

DIGITS = 30
# (d, r, ε, h, a, b): d_α, r_α, ψ_α(0), ψ_α(r_α), by quadrature of 40 digits with another library
REFERENCE = {
    ("7", "8.4", "0.1", "0.2", "5", "5"): (
        *("14.289915602982238", "18.383093559370867", "52.383811786644864", "0.73590113426239231"),
    ),
    ("1.9", "2.8", "0.1", "0.4", "7", "9"): (
        *("1.6661904664719065", "3.3566462856512001", "8.2894763964404246", "1.9197227378044615"),
    ),
    ("15", "18", "0.1", "0.1", "3", "3"): (
        *("38.47679857416329", "47.792733107199559", "77.314354838042652", "0.80748441845582953"),
    ),
}


def alpha_constants(par: AlphaParameters) -> dict[str, arb]:
    """d_α, r_α, c* = ψ_α(0) and ψ_α(r_α) at the present precision."""
    functions = {"d_alpha": d_alpha, "r_alpha": r_alpha, "c_star": c_star, "far_potential": far_potential}
    return {name: function(par) for name, function in functions.items()}


def beta_constants(par: BetaParameters) -> dict[str, arb]:
    """d_β and ψ_β(0) at the present precision."""
    return {"d_beta": d_beta(par), "psi_beta_0": psi_beta(arb(0), par)}


def parameter_sets() -> dict[AlphaParameters | BetaParameters, list[str]]:
    """The parameters of every interaction in the catalogue, with the scenarios that use them."""
    found: dict[AlphaParameters | BetaParameters, list[str]] = {}
    for name in scenarios():
        law = scenario(name).law
        for part, kind in (("alpha", AlphaParameters), ("beta", BetaParameters)):
            interaction = getattr(law, part, None)
            if interaction is not None and all(hasattr(interaction, field) for field in kind.__dataclass_fields__):
                found.setdefault(kind.of(interaction), []).append(name)
    return found


def to_digits(constants: dict[str, arb]) -> bool:
    """Whether each is enclosed within half a unit of its 30th digit."""
    return all(value.rad() < value.abs_lower() * arb(10) ** -DIGITS / 2 for value in constants.values())


def agree(value: arb, printed: str) -> bool:
    """Whether a printed number is the value, rounded in its last digit."""
    _, _, decimals = printed.partition(".")
    return bool(abs(value - arb(printed)) < arb(10) ** -len(decimals) / 2)


def _latex(constants: dict[str, arb]) -> str:
    names = {
        "d_alpha": r"d_\alpha",
        "r_alpha": r"r_\alpha",
        "c_star": r"c^* = \psi_\alpha(0)",
        "far_potential": r"\psi_\alpha(r_\alpha)",
        "d_beta": r"d_\beta",
        "psi_beta_0": r"\psi_\beta(0)",
    }
    rows = (rf"{names[name]} &= {plus_minus(value, DIGITS)}" for name, value in constants.items())
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def _steps() -> Iterator[Step]:
    with ctx.workdps(DIGITS + 15):
        for par, users in parameter_sets().items():
            constants = (alpha_constants if isinstance(par, AlphaParameters) else beta_constants)(par)
            width = max((value.rad() for value in constants.values()), key=float)
            yield Step(
                f"{par} (in {users[0]}{f' and {len(users) - 1} more' if len(users) > 1 else ''}): to {DIGITS} digits",
                to_digits(constants),
                _latex(constants),
                f"balls of radius at most {small(width)}",
            )
        for values, printed in REFERENCE.items():
            constants = alpha_constants(AlphaParameters(*values))
            yield Step(
                f"d = {values[0]}: the values of an independent quadrature lie within the enclosures",
                all(agree(value, text) for value, text in zip(constants.values(), printed, strict=True)),
                evidence=", ".join(printed),
            )


PROOF = Proof(
    id="enclosures",
    title="The constants of every scenario, to 30 digits",
    statement=(
        "d_α, r_α, c* = ψ_α(0), ψ_α(r_α), d_β and ψ_β(0) of the parameters of every scenario lie in the balls of the "
        f"certificate, each narrower than a unit of its digit number {DIGITS}."
    ),
    hypotheses="the parameters are the decimals that are printed; the gain c1α is not included",
    rigour="interval",
    steps=_steps,
    size=9,
)
