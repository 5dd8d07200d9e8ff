"""Averaged headings depend on the zero of angles: two adjacent agents may turn around."""

from fractions import Fraction

from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact

_AWAY = Fraction(1, 100)  # of a turn: how far two agents head to either side of the direction of angle 0
_TURNS = tuple(Fraction(k, 24) for k in range(24))  # by which the flock is turned


def averaged(headings: tuple[Fraction, ...]) -> Fraction:
    """Return the mean of headings in turns, each taken in [0, 1), as a direction in [0, 1)."""
    heading_turns = [heading % 1 for heading in headings]
    return (sum(heading_turns, start=Fraction(0)) / len(heading_turns)) % 1


def _turned() -> Claim:
    """Return the claim that rotating a flock need not rotate its mean headings, in exact fractions of a turn."""
    pair = (_AWAY, -_AWAY)
    differing_turns = [turn for turn in _TURNS if averaged(tuple((h + turn) % 1 for h in pair)) != turn]
    turned_average = averaged(pair)
    return exact("frame-bound", bool(differing_turns), computed=str(turned_average)).described(
        stated="turning the whole flock need not turn the mean headings with it",
        witness={"headings, in turns": [str(_AWAY), str(1 - _AWAY)], "mean": str(turned_average)},
        detail=f"two neighbours at {_AWAY} of a turn to either side of angle 0 both take {turned_average} of a turn: "
        "they turn round; with the flock turned by 1/24 or more they keep straight on",
    )


def _away_from_cut() -> Claim:
    """Return the claim that the mean rotates with the flock unless a heading crosses the angle 0."""
    import sympy as sp

    n, turn, k = sp.Symbol("n", positive=True, integer=True), sp.Symbol("t", real=True), sp.Symbol("k", integer=True)
    heading = sp.IndexedBase("h", real=True)
    turned = sp.expand(sp.Sum(heading[k] + turn, (k, 1, n)) / n)
    mean = sp.Sum(heading[k], (k, 1, n)) / n
    return exact("clear-of-cut", sp.simplify(turned.expand(func=True).doit() - mean.doit() - turn) == 0).described(
        stated="as long as no heading passes the direction of angle 0, the mean turns with the flock",
        detail="a heading h that stays in [0, 2π) is counted as h + t after a turn by t, and Σ (h + t)/n = Σ h/n + t",
    )


def _vectors() -> Claim:
    """Return the claim that the mean unit vector (Vicsek's rule) rotates with the flock for any rotation."""
    import sympy as sp

    a, b, angle_shift = sp.symbols("a b t", real=True)
    mean = sp.exp(sp.I * a) + sp.exp(sp.I * b)
    vectors = sp.exp(sp.I * (a + angle_shift)) + sp.exp(sp.I * (b + angle_shift))
    return exact("vectors", sp.simplify(sp.expand(vectors - sp.exp(sp.I * angle_shift) * mean)) == 0).described(
        stated="the mean unit vector turns with the flock",
        detail="Σ e^(i(θ + t)) = e^(it) Σ e^(iθ): Vicsek's rule knows no direction of angle 0",
    )


@erratum(
    "jlm-cut",
    title="Mean headings depend on where angles are counted from",
    source="ours, on Jadbabaie, Lin and Morse's averages of headings in [0, 2π)",
    references=("jadbabaie-lin-morse-2003", "vicsek-1995"),
    expected={"verified": "frame-bound clear-of-cut vectors"},
    author="flockana",
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """With headings in [0, 2π) the mean of two that differ little across angle 0 points backwards: the linear rule is
    not invariant under rotations of the flock, as a rule of nearest neighbours should be. It is invariant as long as no
    heading passes angle 0; Vicsek's mean of unit vectors always is.
    """
    return [_turned(), _away_from_cut(), _vectors()]
