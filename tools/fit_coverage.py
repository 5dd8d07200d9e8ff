"""How often 95 % intervals of `fit` hold the truth, by kinds of recordings, and how wide they are.

    python -m tools.fit_coverage 200 > table.md        # seeds of each kind; a kind may follow

Widths are compared with those of an oracle that knows the noise: the deviations of least squares at the truth.
"""

import sys
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import flockana as fl
from flockana.recorded.fit import fit
from flockana.recorded.shooting import Problem, matched
from flockana.recorded.windows import usual_window, windows

TRUE = fl.Gains(c1_alpha=20.0, c2_alpha=6.0, c1_gamma=1.5, c2_gamma=1.0)
PAIR = fl.Algorithm1(gains=TRUE)
LED = fl.Algorithm2(gains=TRUE, target=fl.StaticTarget((10.0, 10.0)))


class Case(NamedTuple):
    """A recording with the law that made it, what is fitted, how, and the true deviations of its numbers, (T, w)."""

    rec: fl.Recording
    law: Any
    free: tuple[str, ...]
    sd: Any
    how: dict[str, Any]
    spread: float = 0.0


def run(rng: np.random.Generator, law: Any, n: int, seconds: float, step: float, *, apart: float = 7.0) -> Any:
    """A run of some agents near a lattice, sampled evenly."""
    t = np.arange(round(seconds / step) + 1) * step
    q0 = fl.lattice.triangular(n, apart) + rng.normal(0.0, 0.8, (n, 2))
    return fl.simulate(law, q0, rng.normal(0.0, 1.0, (n, 2)), (0.0, float(t[-1])), t_eval=t)


def columns(rec: fl.Recording, place: float, speed: float | None = None) -> Any:
    """Deviations of all numbers."""
    each = [place] if speed is None else [place, speed]
    return np.repeat(np.array(each), rec.n * rec.m) * np.ones((len(rec.t), 1))


def bound_with_velocities(rng: np.random.Generator) -> Case:
    """Positions and velocities with even errors in a bound; 5 agents."""
    made, b = run(rng, LED, 5, 1.0, 0.05), 10 ** rng.uniform(-3.0, -1.3)
    q, p = (x + rng.uniform(-b, b, x.shape) / np.sqrt(2.0) for x in (made.q, made.p))
    rec = fl.Recording(made.t, q, p, bound=b, p_bound=b)
    return Case(
        rec, LED, ("c1_alpha", "c1_gamma"), columns(rec, b / np.sqrt(6.0), b / np.sqrt(6.0)), {"independent": True}
    )


def sd_positions(rng: np.random.Generator) -> Case:
    """Positions alone with Gaussian errors; 4 agents."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 10 ** rng.uniform(-2.5, -1.2)
    rec = fl.Recording(made.t, made.q + rng.normal(0.0, sd, made.q.shape), sd=sd)
    return Case(rec, LED, ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma"), columns(rec, sd), {})


def sd_with_velocities(rng: np.random.Generator) -> Case:
    """Positions and velocities with Gaussian errors; 4 agents."""
    made, sd = run(rng, LED, 4, 1.0, 0.05), 10 ** rng.uniform(-2.5, -1.0)
    q, p = made.q + rng.normal(0.0, sd, made.q.shape), made.p + rng.normal(0.0, 5.0 * sd, made.p.shape)
    rec = fl.Recording(made.t, q, p, sd=sd, p_sd=5.0 * sd)
    return Case(rec, LED, ("c1_alpha", "c2_alpha"), columns(rec, sd, 5.0 * sd), {})


def few_frames(rng: np.random.Generator) -> Case:
    """A pair at 9 frames."""
    t = np.linspace(0.0, 1.0, 9)
    made = fl.simulate(PAIR, [[0.0], [rng.uniform(5.5, 8.0)]], rng.normal(0.0, 1.0, (2, 1)), (0.0, 1.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.02, made.q.shape), sd=0.02)
    return Case(rec, PAIR, ("c1_alpha", "c2_alpha"), columns(rec, 0.02), {})


def collinear(rng: np.random.Generator) -> Case:
    """A pair that creeps: damping and stiffness are told almost together."""
    law = fl.Algorithm1(gains=fl.Gains(c1_alpha=4.0, c2_alpha=25.0))
    t = np.arange(41) * 0.05
    made = fl.simulate(law, [[0.0], [rng.uniform(5.5, 6.5)]], rng.normal(0.0, 0.3, (2, 1)), (0.0, 2.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.02, made.q.shape), sd=0.02)
    return Case(rec, law, ("c1_alpha", "c2_alpha"), columns(rec, 0.02), {})


def heavy_tails(rng: np.random.Generator) -> Case:
    """Errors of Student's t with 3 degrees of freedom, their deviation stated; the oracle weighs them by likelihood."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 0.03
    rec = fl.Recording(made.t, made.q + sd / np.sqrt(3.0) * rng.standard_t(3, made.q.shape), sd=sd)
    return Case(rec, LED, ("c1_alpha", "c1_gamma"), columns(rec, sd / np.sqrt(3.0) * np.sqrt(6.0 / 4.0)), {})


def touch_once(rng: np.random.Generator) -> Case:
    """Two agents that pass each other and are in range for part of the time."""
    t, law = np.arange(61) * 0.05, fl.Algorithm1(gains=fl.Gains(c1_alpha=20.0, c2_alpha=0.5))
    q0, p0 = [[-9.0, 0.0], [9.0, rng.uniform(4.0, 6.0)]], [[6.0, 0.0], [-6.0, 0.0]]
    made = fl.simulate(law, q0, p0, (0.0, 3.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.03, made.q.shape), sd=0.03)
    return Case(rec, law, ("c1_alpha",), columns(rec, 0.03), {})


def gaps(rng: np.random.Generator) -> Case:
    """Each of 4 agents is hidden for a fifth of the time."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 0.02
    q = made.q + rng.normal(0.0, sd, made.q.shape)
    for i in range(4):
        a = int(rng.integers(2, len(q) - 8))
        q[a : a + 6, i] = np.nan
    rec = fl.Recording(made.t, q, sd=sd)
    return Case(rec, LED, ("c1_alpha", "c2_alpha", "c1_gamma"), columns(rec, sd), {})


def constant_offsets(rng: np.random.Generator) -> Case:
    """Each coordinate of each agent is off by a constant within the bound, and by a little noise."""
    made, b = run(rng, LED, 4, 1.5, 0.05), 0.1
    shift = rng.uniform(-b, b, (1, 4, 2)) / np.sqrt(2.0)
    noise = rng.normal(0.0, 0.002, made.q.shape)
    rec = fl.Recording(made.t, made.q + shift + noise, bound=b + 0.01)
    return Case(rec, LED, ("c1_alpha", "c1_gamma"), columns(rec, 0.002), {}, b / np.sqrt(6.0))


KINDS: dict[str, Callable[[np.random.Generator], Case]] = {
    "bound, with velocities": bound_with_velocities,
    "sd, positions alone": sd_positions,
    "sd, with velocities": sd_with_velocities,
    "few frames": few_frames,
    "collinear gains": collinear,
    "heavy tails": heavy_tails,
    "agents that touch once": touch_once,
    "gaps": gaps,
    "constant offsets": constant_offsets,
}


def oracle(case: Case) -> Any:
    """Widths of the intervals of least squares that knows the noise, at the truth."""
    from flockana.recorded.parameters import FreeParameters

    free = FreeParameters.of(case.law, case.free)
    parts = windows(case.rec, usual_window(case.rec, case.law), case.sd)
    spread = np.full(parts[0].y.shape[1], case.spread) if case.spread else None
    known = matched(Problem(parts, free.with_values, free.values, spread))
    return 2.0 * 1.96 * np.sqrt(np.diag(known.covariance)[: len(case.free)])


def row(name: str, seeds: int) -> str:
    """A line of the table: coverage of the least and of all parameters, widths over the oracle's, what is open."""
    number = list(KINDS).index(name)
    inside, ratios, untold, wrongly = [], [], 0, 0
    for seed in range(seeds):
        case = KINDS[name](np.random.default_rng([number, seed]))
        found, best = fit(case.rec, case.law, free=case.free, **case.how), oracle(case)
        ends = np.array([found.intervals[x] for x in case.free])
        truth = np.array([getattr(case.law.gains, x) for x in case.free])
        inside.append((ends[:, 0] <= truth) & (truth <= ends[:, 1]))
        ratios.append(np.median((ends[:, 1] - ends[:, 0]) / best))
        untold += len(found.unidentifiable)
        wrongly += sum(
            width < 2.0 * value and any(x in text for text in found.unidentifiable)
            for x, width, value in zip(case.free, best, truth, strict=True)
        )
    shares = np.mean(inside, axis=0)
    return f"| {name} | {shares.min():.3f} | {np.mean(inside):.3f} | {np.median(ratios):.2f} | {untold} | {wrongly} |"


def main() -> None:
    """Print the table."""
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    sys.stdout.write(
        "| kind | least covered | covered | width over the oracle's | not told | of these told by the oracle |" + "\n"
    )
    sys.stdout.write("|---|---|---|---|---|---|" + "\n")
    for name in sys.argv[2:] or KINDS:
        sys.stdout.write(row(name, seeds) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
