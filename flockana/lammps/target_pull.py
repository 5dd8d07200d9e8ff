"""Pull to a γ-agent in LAMMPS: variables of each agent added to its force, and viscous drag."""

from flockana.environment.target import Target
from flockana.environment.targets import CircleTarget, LinearTarget, RescaledVelocity, SineTarget, StaticTarget
from flockana.laws.terms.navigation import Navigation

AXES = "xyz"
TIME = "v_t"  # the equal-style variable of the script

Formulas = tuple[tuple[str, str], ...]  # (q_r, p_r) along each axis


def path(target: Target) -> Formulas | None:
    """Return (q_r, p_r) along each axis as formulas in time; None without a known formula."""
    match target:
        case StaticTarget():
            return tuple((repr(q), repr(p)) for q, p in zip(target.q, target.p, strict=True))
        case LinearTarget():
            return tuple((_line(q, p), repr(p)) for q, p in zip(target.q, target.p, strict=True))
        case SineTarget():
            omega, angle = _turning(target)
            formulas = [(_line(q, p), repr(p)) for q, p in zip(target.start, target.velocity, strict=True)]
            q, p = formulas[target.axis]
            a = _number(target.amplitude)
            formulas[target.axis] = (f"{q}+{a}*sin({angle})", f"{p}+{a}*{omega}*cos({angle})")
            return tuple(formulas)
        case CircleTarget():
            (omega, angle), r = _turning(target), repr(target.radius)
            swing = [(f"{r}*cos({angle})", f"-{r}*{omega}*sin({angle})")]
            swing += [(f"{r}*sin({angle})", f"{r}*{omega}*cos({angle})"), ("0.0", "0.0")]
            return tuple((f"{c!r}+{q}", p) for c, (q, p) in zip(target.centre, swing, strict=False))
        case RescaledVelocity():
            return _rescaled(target)
    return None


def _turning(target: SineTarget | CircleTarget) -> tuple[str, str]:
    """Return the angular frequency and the angle of a path, as formulas for the script."""
    omega = f"2.0*PI*{_number(target.frequency)}"
    return omega, f"{omega}*{TIME}+{_number(target.phase)}"


def _rescaled(target: RescaledVelocity) -> Formulas | None:
    inner, given_target = path(target.target), target.target
    if inner is None or isinstance(given_target, StaticTarget):  # whose p_r need not be its rate, which is 0
        return None if inner is None else tuple((q, "0.0") for q, _ in inner)
    if isinstance(given_target, RescaledVelocity):
        return None
    return tuple((q, f"{_number(target.factor)}*({p})") for q, p in inner)


def _number(x: float) -> str:
    """Return a number as text that may follow an operator."""
    return repr(x) if x >= 0.0 else f"({x!r})"


def _line(q: float, p: float) -> str:
    return f"{q!r}+{_number(p)}*{TIME}"


def pull_commands(term: Navigation) -> list[str] | None:
    """Return LAMMPS commands that add the pull to a γ-agent to the forces; None without a formula."""
    formulas, gains = path(term.target), term.gains
    if formulas is None or gains.per_agent:
        return None
    axes = AXES[: len(formulas)]
    lines = []
    for axis, (q, p) in zip(axes, formulas, strict=True):
        lines += [f"variable target_{axis} equal {q}", f"variable target_v{axis} equal {p}"]
    saturation_text = ""
    if term.unit is not None:
        squares = "+".join(f"({axis}-v_target_{axis})^2" for axis in axes)
        lines.append(f'variable bend atom "sqrt(1.0+({squares})/{term.unit!r}^2)"')
        saturation_text = "/v_bend"
    k, c = repr(float(gains.c1_gamma)), repr(float(gains.c2_gamma))
    for axis in axes:
        lines.append(f'variable pull_{axis} atom "-{k}*({axis}-v_target_{axis}){saturation_text}+{c}*v_target_v{axis}"')
    forces = " ".join([f"v_pull_{axis}" for axis in axes] + ["0.0"] * (3 - len(axes)))
    return [*lines, f"fix drag all viscous {c}", f"fix pull all addforce {forces}"]
