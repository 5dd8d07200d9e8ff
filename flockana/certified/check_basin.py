"""Independent checker of basin certificates, with the argument of `basin`.

It and `check_net` share with the prover the scalar functions of `intervals` and nothing else. Everything is in balls or
exact; "true" means certainly true.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

from flint import arb, ctx

from flockana.certified.balls import ball, hull, square
from flockana.certified.check import ensure, positive, unit
from flockana.certified.check_net import ROOT_TWO, Net, Pair
from flockana.certified.forms import BINARY, NUMBER, PAIR_LAW, WHOLE

DIGITS = 45
STATED, OF_RATE = 4, 3  # significant digits


def form(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the expected form of a certificate, by key (`forms`)."""
    numbers = ("box", "second_eigenvalue", "degree", "radius", "level", "curvature", "surplus", "rate", "overshoot")
    return dict.fromkeys((*numbers, "distance"), NUMBER) | {
        "law": PAIR_LAW,
        "positions": [[BINARY]],
        "bonds": [{"pairs": [[WHOLE]], "along": [NUMBER], "across": [NUMBER]}],
        "curvatures": [NUMBER],
        "lyapunov": dict.fromkeys(("eps", "theta", "kappa", "tau"), NUMBER),
    }


def check(data: Mapping[str, Any]) -> Iterator[str]:
    """Verify a basin certificate and return the verified steps."""
    with ctx.workdps(DIGITS):
        net = Net(data)
        x = net.equilibrium()
        yield "exactly one equilibrium, modulo rigid motions, lies in the box about the positions (Krawczyk)"
        radius, shells = Fraction(data["radius"]), len(data["curvatures"])
        reach = radius * ROOT_TWO
        ensure(radius > 0 and ROOT_TWO**2 > 2 and shells > 0, "no radius")
        gaps = {(i, j): [b - a for a, b in zip(x[i], x[j], strict=True)] for i, j in combinations(range(net.n), 2)}
        lengths = {pair: sum(map(square, gap), arb(0)).sqrt() for pair, gap in gaps.items()}
        bonds = [tuple((i, j) for i, j in bond["pairs"]) for bond in data["bonds"]]
        listed = [pair for bond in bonds for pair in bond]
        ensure(len(set(listed)) == len(listed) and set(listed) <= set(gaps), "a pair is listed twice, or is none")
        out = ball(Fraction(str(net.text["r"]))) + ball(reach)
        ensure(all(lengths[pair] >= out for pair in set(gaps) - set(listed)), "a pair may come into range unseen")
        yield f"all but the {len(listed)} pairs listed stay out of range"
        apart = min((lengths[pair] - ball(reach)).lower() for pair in gaps)
        ensure(apart > 0, "agents may collide")
        ensure(round_down_float(data["distance"], apart), "the distance is not that of the closest pair")
        yield "no two agents come nearer than the distance stated"
        for bond, pairs in zip(data["bonds"], bonds, strict=True):
            rest = hull(*(lengths[pair] for pair in pairs))
            ensure(
                len(bond["along"]) == len(bond["across"]) == shells, "a bond has other than one bound for each shell"
            )
            for k, floor in enumerate(zip(bond["along"], bond["across"], strict=True)):
                holds = net.floor_holds(rest, reach * (k + 1) / shells, *map(Fraction, floor))
                ensure(holds, f"pairs {pairs}, shell {k}: no bound")
        yield f"the curvatures along and across of {len(bonds)} kinds of pairs are bounds in each of {shells} shells"
        curvatures = [Fraction(k) for k in data["curvatures"]]
        for k, stated in enumerate(curvatures):
            floors = {
                pair: (Fraction(bond["along"][k]), Fraction(bond["across"][k]))
                for bond, pairs in zip(data["bonds"], bonds, strict=True)
                for pair in pairs
            }
            matrix = net.radial(x, gaps, floors)
            ensure(positive(matrix.tolist(), ball(stated)), f"shell {k}: the curvature is not proved")
            ensure(stated % unit(stated, STATED) == 0, f"shell {k}: the curvature has too many digits")
            ensure(
                not positive(matrix.tolist(), ball(stated + unit(stated, STATED))),
                f"shell {k}: more than the curvature stated is true",
            )
        yield "the curvature of U along displacements is at least what is stated, shell by shell"
        yield from _check_bounds(data, net, x, lengths, curvatures)


def _check_bounds(
    data: Mapping[str, Any], net: Net, x: Sequence[Sequence[arb]], lengths: Mapping[Pair, arb], k: Sequence[Fraction]
) -> Iterator[str]:
    """Check level, curvature, surplus, damping and rate against the shells and the net."""
    radius = Fraction(data["radius"])
    step = radius / len(k)
    slopes = [step * sum(k[: i + 1], Fraction(0)) for i in range(len(k))]  # G' at the shells' ends
    level = step * (sum(slopes, Fraction(0)) - slopes[-1] / 2)
    ends = [step * (i + 1) for i in range(len(k))]
    moments = [sum((k[j] * (2 * j + 1) for j in range(i + 1)), Fraction(0)) / (2 * (i + 1) ** 2) for i in range(len(k))]
    ensure(round_down_float(data["level"], level), "the level is not that of the shells")
    ensure(
        round_down_float(data["curvature"], min(s / t for s, t in zip(slopes, ends, strict=True))),
        "the least curvature",
    )
    ensure(round_down_float(data["surplus"], min(moments)), "the surplus is not that of the shells")
    curvature, surplus = Fraction(data["curvature"]), Fraction(data["surplus"])
    ensure(curvature > 0 and level > 0, "the potential does not rise")
    yield "U at the boundary of the ball exceeds its minimum by the level; all equilibria in the ball are on the orbit"
    away = ball(radius * ROOT_TWO)
    second, degree = Fraction(data["second_eigenvalue"]), Fraction(data["degree"])
    weak = {pair: net.weight(length + away).lower() for pair, length in lengths.items()}
    laplacian = net.laplacian(weak)
    proved = second >= 0 and (second == 0 or positive(laplacian.tolist(), ball(second)))
    ensure(proved, "the net's second eigenvalue is not proved")
    more = second + unit(second, STATED) if second else Fraction(1, 10**6)
    ensure(not positive(laplacian.tolist(), ball(more)), "the net's second eigenvalue is larger than stated")
    near = {pair: net.weight((length - away).max(arb(0))) for pair, length in lengths.items()}
    degrees = [sum((w for pair, w in near.items() if i in pair), arb(0)).upper() for i in range(net.n)]
    ensure(round_down_float(str(-degree), -max(degrees)), "the largest degree is not that of the net")
    least, most = net.c2_gamma + net.c2_alpha * second, net.c2_gamma + 2 * net.c2_alpha * degree
    ensure(least > 0, "nothing damps")
    yield "relative velocities are damped, the net's part from its second eigenvalue at its longest lengths"
    eps, theta, kappa, tau = (Fraction(data["lyapunov"][name]) for name in ("eps", "theta", "kappa", "tau"))
    ensure(0 < eps <= 2 * kappa and 0 <= theta <= 1 and tau > 0 and eps**2 < curvature, "no Lyapunov function")
    mean = theta * surplus + (1 - theta) * curvature
    rate = min(
        eps * theta,
        eps * (theta * curvature + 2 * mean - kappa * most) / (curvature + eps * tau),
        2 * ((1 - eps / (2 * kappa)) * least - eps) / (1 + eps / tau),
    )
    ensure(rate > 0 and round_down_float(data["rate"], rate / 2, OF_RATE), "the rate is not that of F")
    share = ball(eps) / ball(curvature).sqrt()
    ensure(round_down_float(str(-Fraction(data["overshoot"])), -(1 + share) / (1 - share), OF_RATE), "the overshoot")
    yield "F = E + ε⟨w, v⟩ falls at twice the rate, and is E but for the overshoot"
    ensure(net.unique_projection(x, ball(radius)), "the nearest point of the orbit may not be unique")
    yield "the nearest point of the orbit is unique, and not degenerate"


def round_down_float(stated: str, value: Any, digits: int = STATED) -> bool:
    """Return whether a stated number is the value rounded down to the given digits."""
    number = Fraction(stated)
    above = number + unit(number, digits)
    if number % unit(number, digits):
        return False
    if isinstance(value, Fraction):
        return number <= value < above
    return bool(ball(number) <= value) and bool(value < ball(above))
