"""What the course's checks must refuse and take: for each exercise at least three wrong answers and two right ones.

Three of the wrong ones have the right form, so that the check looks at their values.

Right answers are such as a student may hand in: rounded to what the question asks for, exact, of another type.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np

import flockana as fl
from flockana.plots import subplots
from flockana.theorems import Theorem
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import law_is

_STEPS = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1) if abs(a) + abs(b) + abs(c) in (0, 2)]
THIRTEEN = np.array(_STEPS) * 7.0 / np.sqrt(2)


GRID = np.array([[float(k % 4), float(k // 4)] for k in range(13)])
TRAP = [14.197296408684533, 0.0]  # a saddle
CUP = [51.80929865335846, 0.0]  # a minimum


def connectivity(*, closed: bool = False, hops: int = 9) -> Callable[[Any, float], float]:
    """The relative connectivity, with links of length r if `closed`, looking no farther than so many links."""

    def found(q: Any, r: float) -> float:
        length = np.linalg.norm(np.asarray(q)[:, None] - q, axis=2)
        reached = np.linalg.matrix_power((length <= r if closed else length < r).astype(float), hops) > 0
        return float((len(q) - len({tuple(row) for row in reached})) / (len(q) - 1))

    return found


FIRST = fl.AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0)


def six_axes(run: Any, *, labels: bool = True, junk: bool = False) -> Any:
    """Six axes with what assignment A1 asks for, or each with the same line."""
    axes, speed = np.ravel(subplots(2, 3)[1]), np.linalg.norm(run.p, axis=2)
    sets = [run.q[0].T, run.q[-1].T, run.q.T, (run.t, speed.T), (run.t, run.metrics().connectivity.values)]
    for ax, (x, y) in zip(axes, [*sets, run.q.mean(axis=1).T], strict=True):
        ax.plot(run.t if junk else x.T, run.t if junk else y.T, "o-")
        if labels:
            ax.set(xlabel="x", ylabel="y")
    return axes


def in_one_plot(run: Any) -> Any:
    """Six axes, of which one shows everything."""
    axes, full = np.ravel(subplots(2, 3)[1]), six_axes(run)
    for line in [line for ax in full for line in ax.lines]:
        axes[0].plot(*line.get_data(), "o-")
    axes[0].set(xlabel="x", ylabel="y")
    return axes


def in_one_place(q: Any, r: float) -> float:
    """One component, whatever the agents do."""
    return 1.0


@dataclass(frozen=True)
class Drag(fl.Law):
    """A student's law: u = -p."""

    def flow(self, t: float, q: Any, p: Any) -> tuple[Any, float]:
        return -p, -float(np.sum(p**2))

    def hamiltonian(self, t: float, q: Any, p: Any) -> float:
        return 0.5 * float(np.sum(p**2))


class Renamed(fl.Algorithm1):
    """A law of the library under a name of one's own."""


def capstone(dimension: int, *, holds: bool = True, id: str = "drag", law: Any = Drag()) -> list[Any]:
    """A theorem of one's own, a run on which it is verified, and what stands for a proof."""
    theorem = Theorem(
        id=id,
        title="Drag takes energy",
        statement="T falls.",
        source="ours",
        kind="trajectory",
        check=lambda seen, tolerances: ([], [judged("falls", seen.energy[0] - seen.energy[1:], detail="T is smaller")]),
        references=(),
        law=law_is("drag", type(law)),
        claims=("falls",),
    )
    q = np.array([[0.0] * dimension, [7.0] + [0.0] * (dimension - 1)])
    proof = SimpleNamespace(steps=lambda: iter([SimpleNamespace(holds=True), SimpleNamespace(holds=holds)]))
    return [theorem, fl.simulate(law, q, q + 1.0, (0.0, 1.0)), proof]


# Force 2 s (s² - 1) (9 - s²)² (8.41 - s²), its integral from s to 3: vanishes twice at the range, repels from 2.9 on.
REPELS_AGAIN = "(9 - s**2)**5/5 - 2.1475*(9 - s**2)**4 + 118*(9 - s**2)**3/75"


def also_zero_at(a: float, b: float) -> str:
    """A text whose force s (1 - s²) (9 - s²)² (s² - a²) (s² - b²) changes sign at a and b, too; in u = 9 - s²."""
    A, B = 9 - a**2, 9 - b**2  # dV/du = -½ (8 - u) u² (A - u) (B - u)
    c = (8 * A * B, -(A * B + 8 * (A + B)), 8 + A + B, -1.0)
    return " + ".join(f"({-0.5 * each / k!r})*(9 - s**2)**{k}" for k, each in enumerate(c, 3))


ANSWERS: dict[str, dict[str, Any]] = {  # wrong ones and right ones, or who makes them
    "00": {
        "collapse_status": (["verified", "vacuous", "inconclusive", True, ["refuted"]], ["Refuted", " refuted "]),
        "connectivity": (
            [lambda q, r: 0.128, in_one_place, connectivity(closed=True), connectivity(hops=1), fl.min_distance],
            [connectivity(), connectivity(hops=99)],
        ),
        "residual": ([2.1e-7, 0.0032, 0.0034, 0.036, 0.33], [0.0033, 0.003346, np.float32(0.0033)]),
        "push": (
            [[-3.0, -4.0, 5.0], [-3, -4, 5, 8], [-3, 4, 5, 8], [-3, -4, 7, -8]],
            [[-3, -4, 5, -8], (-3.0, -4.0, np.hypot(3, 4), -8)],
        ),
        "pair": (
            [[[0, 0], [8, 0]], [[0, 0], [7, 0]], [[0, 9]], 9.0],
            [[[0, 0], [9, 0]], np.array([[1.0, 2.0], [1.0, 2.0]])],
        ),
        "joined": ([0.0, 1.0, 10.0, 60.0], [2.2795, 2.0, 3, np.float64(2.5)]),
    },
    "00a": {
        "lambda_2": ([0.0, 3.0, 2.0, 0.99], [1, 1.0, Fraction(1)]),
        "rank": ([3, 11, 12, 8], [9, 9.0]),
        "agreement": (
            [1.382, [5, 1.38, 0.691], [5, 0.691, 1.382], [4, 1.727, 0.863]],
            [[5, 1.382, 0.6908], (5.0, np.log(1000) / 5, np.log(1000) / 10)],
        ),
        "damping": ([0.8, 2.0, 1.59, -1.6], [1.6, Fraction(8, 5), 2 * 0.8]),
        "bound": ([1.571, 2.47, 2.466, 2.468], [2.467, 2.4674, np.pi**2 / 4]),
        "fastest_net": (
            [[(0, 1), (1, 2), (2, 3), (3, 4)], [(0, 1), (0, 2), (0, 3), (3, 4)], [(0, k) for k in (1, 2, 3)], 4],
            [[(2, k) for k in (0, 1, 3, 4)], np.array([[k, 4] for k in range(4)])],
        ),
        "least_range": ([3.5, 4.5, 3.9, True], [4, 4.0, np.float64(4.0)]),
    },
    "01": {
        "sigmoid": (
            [[0.8944, -2.0], [0.894, -2.0, -5.0], [-0.8944, -2.0, -5.0], [0.8944, 0.0, -5.0]],
            [[0.8944, -2, -5], (2 / 5**0.5, -2.0, -5.0)],
        ),
        "pairs": ([71, 71.1, 71.3, 1 / 71.18], [71.2, 71.18, 71.1832]),
        "jump": ([0.0, 0.99, True, -1.0], [1, np.int64(1), [1][0]]),
        "strongest": (
            [7.314, [7.316, 7.314], [7.31, 7.32], [7.7, 7.7]],
            [[7.314, 7.316], np.array([7.31396, 7.31571])],
        ),
        "slope": ([5.0, 0.91, 0.9, 0.0], [0.8963, 0.896325033, np.float64(0.896325)]),
        "strength": ([95, 95.4, 95.44, 95.46, 19.09], [95.45, 95.449, np.float64(95.449335)]),
        "least_h": ([0.5, 0.7, 0.55, 2.686], [0.6, np.float64(0.6), Fraction(3, 5)]),
    },
    "02": {
        "components": ([24, 25, 35, 14], [26, 26.0, np.int64(26)]),
        "start": ([6.57, 6.567, 6.569, 8.4], [6.568, 6.5676, np.float64(6.567645272)]),
        "drift": ([1e-9, 0.5, 1.0, True], [0, 6.8e-16, np.float64(-1e-12)]),
        "parting": (
            [3.261, [3.394, 1.63, 1.84], [3.394, 3.685, 3.261], [3.39, 3.26, 3.68]],
            [[3.394, 3.261, 3.685], (3.3944, 3.26098, 3.68478)],
        ),
        "torn": (
            [[[0, 0]], 5, np.zeros((2, 2)), [[0, 0], [7, 0]], [[0, 0], [9, 0]]],
            [[[0, 0], [1, 0]], np.array([[1.0, 1.0], [1.0, 2.0], [1.0, 3.0]])],
        ),
        "groups": ([1, 4, 27, 2], [3, 3.0, np.int64(3)]),
    },
    "03": {
        "c2_gamma": ([14.1, 7.071, 50, 16.73], [14.14, 2 * np.sqrt(50), 2 * 50**0.5]),
        "right_share": ([0.009, 0.74, 0.7371, 0.7382, 1.0], [0.7372, 0.73724, 0.7372359]),
        "lag": (
            [[5.721, 5.721, 0.0], [5.72, 2.86, 0.0], [2.86, 5.721, 0.0]],
            [[5.721, 2.860, 0.0], (6 / 1.1**0.5, 3 / 1.1**0.5, 0)],
        ),
        "nearest": ([0.0, 7.0, 5.4, 5.45], [5.46, 5.459, 5.45931]),
        "chosen": ([[5, 5], [4.0, 4.0], [1.1, 2.1], [70, 16.7], [4.0]], [[4.8, 4.2], (5, 4.4), (5, 4)]),
        "first_shared": ([1.0, 1.6, 0.05, 3.0], [1.2, Fraction(6, 5), np.float64(1.2)]),
    },
    "04": {
        "counts": (
            [265, [300, 265, 197], [294, 264, 197], [294, 265, 198]],
            [[294, 265, 197], np.array([294.0, 265.0, 197.0])],
        ),
        "safe": ([0.85, 0.707, 0.847, 1.2], [0.849, 0.8485, 1.2 / 1.4142]),
        "thirteen": ([THIRTEEN[:12], THIRTEEN / 7.0, THIRTEEN * 1.01, 36], [THIRTEEN, THIRTEEN.tolist()]),
        "links_of_two": ([[0, 1], [1, 3], [2, 0], 1], [[1, 0], (1.0, 0.0)]),
        "crossing": (
            # too large; a chain; two pairs in one place each; all on a line
            [
                [[0, 0], [7, 0], [7, 7], [0, 7]],
                [[0, 0], [6, 0], [12, 0], [18, 1]],
                [[0, 0], [0, 0], [5, 5], [5, 5]],
                [[0, 0], [1, 0], [2, 0], [3, 0]],
            ],
            [[[0, 0], [5, 0], [5, 5], [0, 5]], np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]])],
        ),
        "too_far": ([1.7, 1.73, 1.9, 1.2], [1.75, 7 / 4, np.float64(1.75)]),
    },
    "05": {
        "shadow": (
            [[1.5, -5.5, 3.0], [1.5, 5.5, 1.0], [3.0, -1.0, 1.0]],
            [[1.5, -5.5, 1], (Fraction(3, 2), -5.5, 1.0)],
        ),
        "reached": ([4.1, 4.11, 4.13, 4.0], [4.12, 4.122, 4.1219]),
        "curvature": ([True, 0.0, 2.0, -4.0], [4, 4.0, np.float64(4.0)]),
        "work": ([16.0, -25.0, -9.0, 0.0], [-16, -16.0, Fraction(-16)]),
        "far": ([0.99, 7.0, 7.1, 49.25], [7.018, 7.0179, 0.99 / (1 - 0.99**2) ** 0.5]),
        "trap": ([[-60, 0], [0, 0], [120.0, 0.0], [51.8, 0.0], TRAP, 12], [CUP, np.array(CUP), tuple(CUP)]),
        "most_groups": ([1, 2, 4, 37], [3, 3.0, np.int64(3)]),
    },
    "06": {
        "zeros": ([3, 6, 12, 8], [9, 9.0, np.int64(9)]),
        "pair_damping": ([0.0657, [0.0929, 118], [0.0657, 15.5], [167, 0.0657]], [[0.0657, 167], (0.0657, 166.7)]),
        "best": ([1.58, 2.5, 2.098, 3.16], [3.162, 2 * 2.5**0.5, 3.1623]),
        "residual": ([0.04, 0.045, 0.043, 0.44], [0.044, 0.0444, np.float64(0.04443)]),
        "delay": ([0.647409203 / 2, 0.5, 2.058, 0.65], [0.6474, 0.647409203, np.float64(0.647409)]),
        "ring_ratio": ([1.0, 2.7, -1.4, 0.7], [1.4, 1.437, 1.44]),
        "slower": ([[4.0, 16.0], [100.0, 16.0], [16.0, 20.0], 16.0], [[16.0, 100.0], (12, 100)]),
        "one_mode": (
            [[0.02, 0.00125], [0.5, 0.00125, 0.000625], [0.02, 0.00125, 0.0025], [0.02, 0.0025, 0.00125]],
            [[0.02, 0.00125, 0.000625], (Fraction(1, 50), Fraction(1, 800), Fraction(1, 1600))],
        ),
        "seven_sampled": (
            [[0.0128, 2.05], [2.05, 0.0263], [0.0525, 2.05]],
            [[0.0263, 2.05], np.array([0.02626, 2.0545])],
        ),
    },
    "07": {
        "n_none": ([22, 24, 30, 4.6], [23, 23.0, np.int64(23)]),
        "moved": (
            [0.03, [0.01, 0.03], [0.03, 0.02], [0.02, 0.01]],
            [[0.03, 0.01], (Fraction(3, 100), Fraction(1, 100))],
        ),
        "status": (["refuted", "verified", "inconclusive", False], ["vacuous", "Vacuous"]),
        "scattered": ([12, 14, 71, 9], [13, 13.0, np.int64(13)]),
        "costly": ([[[0, 0], [7, 0]], 7.0 * GRID[:12], 13, 1.1 * GRID], [9.0 * GRID, (20.0 * GRID).tolist()]),
        "passing": ([2, [0.0095, 0.0189], [0.0284, 0.0095], [0.0, 0.0284]], [[0.0095, 0.0284], [0.01, 0.03]]),
    },
    "08": {
        "fastest": ([2.0, 1.63, 1.627, 1.629], [1.628, 1.6278, 1.62779]),
        "push": (
            [[0.5, 0.0, 1.0], [-0.5, 0.0, 1.0], [0.5, 0.0], [0.5, 0.0, -0.99]],
            [[0.5, 0, -1], (Fraction(1, 2), 0.0, -1.0)],
        ),
        "count": ([8, 3, 10, 12], [11, 11.0, np.int64(11)]),
        "least": ([0.07, 0.0706, 0.071, 1.5], [0.0707, 0.07066, 0.070659]),
        "threshold": ([1.0, 0.75, 1.33, 4.0], [1.333, Fraction(4, 3), 4 / 3]),
        "end_speed": ([0.0, 1.0, 0.95, 0.5], [0.956, 0.95595, np.float64(0.9559)]),
    },
    "09": {
        "rise": ([5.756, 5.81, 5.82, 5.816, 0.0], [5.817, 5.8171, 5.81707]),
        "energy": ([240, 239.7, 239.9, 119.9], [239.8, 239.76, 239.764]),
        "parting": ([[3], [2, 3, 4], [1, 2], [2, 3], [1, 4]], [[4, 3], (3, 4), np.array([3.0, 4.0])]),
        "share": ([0.001, 0.00108, 0.00106, 0.999], [0.00107, 0.001072, 0.035 / 32.646681]),
        "nearest": ([1.794, [1.794, 1.794], [1.79, 1.16], [1.157, 1.794]], [[1.794, 1.157], (1.79401084, 1.15724)]),
        "throws": ([2, 8, 10, 18], [9, 9.0, np.int64(9)]),
    },
    "10": {
        "lower": ([[0.94, 0.97], [0.929, 0.964], [0.9418, 0.9705]], [[0.9289, 0.9638], (0.025**0.02, 0.025**0.01)]),
        "runs_needed": ([367, 369, 299, 100], [368, 368.0, np.int64(368)]),
        "evaluations": ([0, 2, 20], [1, np.int64(1)]),
        "unseen": ([0.6, 0.4528, 0.94, 0.547], [0.5472, 0.99**60, 0.54716]),
        "runs_for_one": ([298, 300, 95, 60], [299, 299.0, np.int64(299)]),
        "met_at": ([0.0, 4.0, 1.4, 20.0], [2.4, 2.3, np.float64(2.39971)]),
    },
    "11": {
        "lacking": ([0, 1, 3], [2, 2.0]),
        "stiffness": ([2.0, [2.0, 0.2604], [8.0, 0.1586], [-2.0, 0.1586]], [[2, 0.1586], (2.0, 0.15859863)]),
        "residual": ([0, 2, 0.9, -1], [1, 1.0]),
        "formula": (
            # the last but one holds at 1, and repels again from 2.9 on
            [
                "1/s + s",
                "(s - 1)**2*s**2",
                "(s**2 - 1)**2",
                3,
                "(s**2 - 1)**2*(9 - s**2)**3",
                REPELS_AGAIN,
                "(9 - s**2)**4",
                also_zero_at(0.97, 0.985),
                also_zero_at(2.511, 2.513),
            ],
            ["(9 - s**2)**4/4 - 8*(9 - s**2)**3/3", "(9 - s**2)**4*3 - 32*(9 - s**2)**3 + 5"],
        ),
        "escape": ([0.785, 0.7863, 1.5708, 0.5], [0.7854, np.pi / 4, 0.785398]),
        "capstone": lambda: (
            # nothing; numbers; a text; the library's theorem; the library's law; the lecture's theorem; both of
            # the library under other names; no proof
            [
                [],
                [1, 2, 3],
                "done",
                [fl.theorem("energy"), *capstone(1)[1:]],
                [
                    capstone(1)[0],
                    fl.simulate(fl.Algorithm1(), [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 1.0)),
                    capstone(1)[2],
                ],
                capstone(1, id="cucker-smale"),
                [replace(fl.theorem("energy"), id="mine"), *capstone(1)[1:]],
                capstone(1, law=Renamed()),
                [*capstone(1)[:2], SimpleNamespace(steps=lambda: iter(()))],
                capstone(1, holds=False),
            ],
            [capstone(1), tuple(capstone(2))],
        ),
        "spread": ([2.0, 1.0, 0.38, 2.7], [2.6, 2.608, np.float64(2.6082)]),
    },
    "12": {
        "degrees": ([0.0, 10, 179.9, 360], [180, 180.0, np.float64(180)]),
        "delay": ([[0.5236, 0.5236], [0.262, 0.262], [1.571, 0.2618]], [[0.2618, 0.2618], (np.pi / 12, np.pi / 12)]),
        "count": ([1, 3, 5], [2, 2.0]),
        "rate": ([0.247, 0.2470, 0.2472, -0.2471], [0.2471, 0.24711, 0.247106]),
        "weight": ([3.142, 0.785, 1.5708, 0.3927], [0.7854, np.pi / 4, 0.785398]),
        "grows": ([1.0, 1.1, 0.9, 1.04], [1.05, Fraction(21, 20), np.float64(1.05)]),
    },
    "13": {
        "largest": ([0.2, 0.141, 0.1413, 0.1415], [0.1414, 0.2 / 2**0.5, 0.14142]),
        "reached": ([0.1414, 0.06, 0.08, 0.071], [0.07, 0.0704, 0.07038571]),
        "levels": (
            [[4.0, 4.0], [4.0, 8.0, 8.0], [4.0, 2.0, 8.0], [8.0, 4.0, 4.0]],
            [[4, 4, 8], (4.0, Fraction(4), 8.0)],
        ),
        "wait": ([34.54, 17.3, 13.8, 17.26], [17.27, 17.2694, np.log(1e6) / 0.8]),
        "turned": ([0.0, -9.0, 0.158, 120.0], [9.0, 9.03, np.float64(9.0298)]),
    },
    "14": {
        "limits": ([0.5, [0.5, 1, 0.5], [2.0, 2, 0.5], [0.5, 2, 1.0]], [[0.5, 2, 0.5], (Fraction(1, 2), 2.0, 0.5)]),
        "friction": ([2.0, 0.5, 1.4142, True], [1, 1.0, Fraction(1)]),
        "rhombus_period": ([0.5, 0.0176, 0.0414, 0.0208], [0.0207, 0.02072, np.float64(0.0207228)]),
        "braked": ([[1.0, 1.0, 2.0], [1.0, 5.0, 1.0], [9.0, 1.0, 5.0], 5.0], [[1.0, 1.0, 5.0], (2, 3, 9)]),
        "turned": ([0.0, 0.076, 60.0, 2.0], [4.3, 4, np.float64(4.348)]),
    },
    "15": {
        "blur": ([0.49, [0.2, 0.05], [0.122, 0.49], [0.49, 0.245]], [[0.490, 0.122], (6**0.5 / 5, 6**0.5 / 20)]),
        "flawed": (
            [fl.Algorithm1, lambda q, p: 0.0 * q, lambda q, p: fl.Algorithm1().acceleration(0.0, q, p), 1.0],
            [
                lambda q, p: fl.Algorithm1().acceleration(0.0, q, np.zeros_like(q)),
                lambda q, p: fl.Algorithm1(gains=fl.Gains(c2_alpha=1e-14)).acceleration(0.0, q, p).tolist(),
            ],
        ),
        "unknown_gain": ([10.95, 4.2, 6.4, 30.0], [6.3, 6.3003, Fraction(63, 10)]),
        "calmed": ([5.6, 0.82, 0.08, 1.0], [0.18, 0.179, np.float64(0.17915)]),
        "silent": (
            # at rest relative to each other; on the taper of the bump; two numbers; too near; out of range, no friction
            [
                [0.0, 2.0, 1.0, 1.0],
                [0.0, 6.0, 1.0, -1.0],
                [0.0, 2.0],
                [0.0, 0.5, 1.0, -1.0],
                [0.0, 9.0, 1.0, -1.0],
                6.0,
            ],
            [[0.0, 2.0, 1.0, -1.0], (1, 3.9, 0, 1), np.array([0.0, -2.5, 0.0, 2.0])],
        ),
    },
    "A1": {
        "figures": (
            [
                lambda run: [],
                lambda run: six_axes(run, junk=True),
                lambda run: six_axes(run, labels=False),
                in_one_plot,
                6,
            ],
            [six_axes, lambda run: list(six_axes(run))],
        ),
        "drift": ([1.0, 25.0, 1e-3, True], [0, 0.0, np.float64(1e-16)]),
        "period": ([6.28, 3.142, 1.0, 6.282], [6.283, 2 * np.pi, 6.28319]),
        "far_side": ([300.0, 274.0, 25.0, 125.0], [275, 275.0, Fraction(275)]),
        "sine_ratio": ([0.85, 0.8517, 1.109, 85.18], [0.8518, 0.851764, np.float64(0.85176)]),
        "true_ratio": ([0.852, 1.1, 1.12, 1.104], [1.11, 1.109, np.float64(1.1093)]),
        "equal_circles": ([16.73, 11.3, 11.32, 8.367], [11.31, 11.306, np.float64(11.3060009)]),
        "faster_and_larger": (
            [[70.0, 0.0, 1.0, 8.0], [70.0, 16.73, 8.0, 1.0], [1.0], 70.0],
            [[70.0, 1.0, 1.0, 8.4], (1.0, 0.1, 0.1, 1.0)],
        ),
    },
    "A2": {
        "c": ([0.25, 0.1255, 0.1259, -0.126], [0.1260, 0.125988, 1 / 63**0.5]),
        "action": (
            [FIRST.phi_alpha, lambda z: FIRST.phi_alpha(z) + 1e-6, lambda z: fl.AlphaInteraction().phi_alpha(z), 1.0],
            [lambda z: FIRST.phi_alpha(z), lambda z: FIRST.phi_alpha(np.array([z]))[0]],
        ),
        "factor": ([10.0, 9.92, 9.921, 1.008], [9.922, 9.92168, np.float64(9.921680)]),
        "share": ([0.0, 27.0, 0.5, True], [1, 1.0, Fraction(1)]),
        "wait": ([6.908, 13.8, 13.81, 27.63], [13.82, 13.8155, 2 * np.log(1000)]),
        "rest": ([5.0, 5.35, 5.1, 4.3], [5.7, Fraction(57, 10), 5 + 0.7]),
        "mended": ([[0.5, 0.5], [5.0, 4.0], [0.0, 0.5], [9.0, 2.0], 5.0], [[5.0, 1.2], (5, 1.3), np.array([4.0, 1.0])]),
    },
}
