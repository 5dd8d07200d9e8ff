"""How often 95 % intervals of `fit` hold the truth, by kinds of recordings, and how wide they are.

    python -m tools.fit_coverage 200 outcomes.jsonl        # seeds of each kind; kinds may follow

Cases run on all cores that the process may use. Outcomes are kept in the file, so that a run that was interrupted goes
on.

Widths are compared with those of an oracle that knows the noise: the deviations of least squares at the truth.
"""

import json
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import flockana as fl
from flockana.ensemble.worker_processes import cores
from flockana.recorded.fit import fit
from flockana.recorded.law_parameters import FreeParameters
from flockana.recorded.matching_windows import usual_window, windows
from flockana.recorded.shooting import NormalEquations, Problem

TRUE = fl.Gains(c1_alpha=20.0, c2_alpha=6.0, c1_gamma=1.5, c2_gamma=1.0)
PAIR = fl.Algorithm1(gains=TRUE)
LED = fl.Algorithm2(gains=TRUE, target=fl.StaticTarget((10.0, 10.0)))


class Case(NamedTuple):
    """A recording with its run, the law, what is fitted, how, and the true deviations of its numbers, (T, w)."""

    made: fl.Trajectory
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
        made,
        rec,
        LED,
        ("c1_alpha", "c1_gamma"),
        columns(rec, b / np.sqrt(6.0), b / np.sqrt(6.0)),
        {"independent": True},
    )


def sd_positions(rng: np.random.Generator) -> Case:
    """Positions alone with Gaussian errors; 4 agents."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 10 ** rng.uniform(-2.5, -1.2)
    rec = fl.Recording(made.t, made.q + rng.normal(0.0, sd, made.q.shape), sd=sd)
    return Case(made, rec, LED, ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma"), columns(rec, sd), {})


def sd_with_velocities(rng: np.random.Generator) -> Case:
    """Positions and velocities with Gaussian errors; 4 agents."""
    made, sd = run(rng, LED, 4, 1.0, 0.05), 10 ** rng.uniform(-2.5, -1.0)
    q, p = made.q + rng.normal(0.0, sd, made.q.shape), made.p + rng.normal(0.0, 5.0 * sd, made.p.shape)
    rec = fl.Recording(made.t, q, p, sd=sd, p_sd=5.0 * sd)
    return Case(made, rec, LED, ("c1_alpha", "c2_alpha"), columns(rec, sd, 5.0 * sd), {})


def few_frames(rng: np.random.Generator) -> Case:
    """A pair at 9 frames."""
    t = np.linspace(0.0, 1.0, 9)
    made = fl.simulate(PAIR, [[0.0], [rng.uniform(5.5, 8.0)]], rng.normal(0.0, 1.0, (2, 1)), (0.0, 1.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.02, made.q.shape), sd=0.02)
    return Case(made, rec, PAIR, ("c1_alpha", "c2_alpha"), columns(rec, 0.02), {})


def collinear(rng: np.random.Generator) -> Case:
    """A pair that creeps: damping and stiffness are told almost together."""
    law = fl.Algorithm1(gains=fl.Gains(c1_alpha=4.0, c2_alpha=25.0))
    t = np.linspace(0.0, 2.0, 41)
    made = fl.simulate(law, [[0.0], [rng.uniform(5.5, 6.5)]], rng.normal(0.0, 0.3, (2, 1)), (0.0, 2.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.02, made.q.shape), sd=0.02)
    return Case(made, rec, law, ("c1_alpha", "c2_alpha"), columns(rec, 0.02), {})


def heavy_tails(rng: np.random.Generator) -> Case:
    """Errors of Student's t with 3 degrees of freedom, their deviation stated; the oracle weighs them by likelihood."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 0.03
    rec = fl.Recording(made.t, made.q + sd / np.sqrt(3.0) * rng.standard_t(3, made.q.shape), sd=sd)
    return Case(made, rec, LED, ("c1_alpha", "c1_gamma"), columns(rec, sd / np.sqrt(3.0) * np.sqrt(6.0 / 4.0)), {})


def touch_once(rng: np.random.Generator) -> Case:
    """Two agents that pass each other and are in range for part of the time."""
    t, law = np.linspace(0.0, 3.0, 61), fl.Algorithm1(gains=fl.Gains(c1_alpha=20.0, c2_alpha=0.5))
    q0, p0 = [[-9.0, 0.0], [9.0, rng.uniform(4.0, 6.0)]], [[6.0, 0.0], [-6.0, 0.0]]
    made = fl.simulate(law, q0, p0, (0.0, 3.0), t_eval=t)
    rec = fl.Recording(t, made.q + rng.normal(0.0, 0.03, made.q.shape), sd=0.03)
    return Case(made, rec, law, ("c1_alpha",), columns(rec, 0.03), {})


def gaps(rng: np.random.Generator) -> Case:
    """Each of 4 agents is hidden for a fifth of the time."""
    made, sd = run(rng, LED, 4, 1.5, 0.05), 0.02
    q = made.q + rng.normal(0.0, sd, made.q.shape)
    for i in range(4):
        a = int(rng.integers(2, len(q) - 8))
        q[a : a + 6, i] = np.nan
    rec = fl.Recording(made.t, q, sd=sd)
    return Case(made, rec, LED, ("c1_alpha", "c2_alpha", "c1_gamma"), columns(rec, sd), {})


def constant_offsets(rng: np.random.Generator) -> Case:
    """Each coordinate of each agent is off by a constant within the bound, and by a little noise."""
    made, b = run(rng, LED, 4, 1.5, 0.05), 0.1
    shift = rng.uniform(-b, b, (1, 4, 2)) / np.sqrt(2.0)
    noise = rng.normal(0.0, 0.002, made.q.shape)
    rec = fl.Recording(made.t, made.q + shift + noise, bound=b + 0.01)
    return Case(made, rec, LED, ("c1_alpha", "c1_gamma"), columns(rec, 0.002), {}, b / np.sqrt(6.0))


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
    free, parts = FreeParameters.of(case.law, case.free), windows(case.rec, usual_window(case.rec, case.law), case.sd)
    spread = np.full(parts[0].y.shape[1], case.spread) if case.spread else None
    at = [int(np.searchsorted(case.rec.t, part.t[0])) for part in parts]
    starts = [np.concatenate([case.made.q[k].ravel(), case.made.p[k].ravel()]) for k in at]
    values = np.concatenate([free.values, np.zeros(0 if spread is None else len(spread))])
    slopes = Problem(parts, free.with_values, free.values, spread).slopes(values, starts, 4, 0.1)
    return 2.0 * 1.96 * np.sqrt(np.diag(NormalEquations.of(slopes, len(values), 0.0).covariance)[: len(case.free)])


def outcome(name: str, seed: int) -> dict[str, Any]:
    """Ends of the intervals of one case, its truth, the oracle's widths, and the parameters called unidentifiable."""
    case = KINDS[name](np.random.default_rng([list(KINDS).index(name), seed]))
    result = fit(case.rec, case.law, free=case.free, **case.how)
    return {
        "kind": name,
        "seed": seed,
        "ends": [result.intervals[x] for x in case.free],
        "truth": [getattr(case.law.gains, x) for x in case.free],
        "oracle": oracle(case).tolist(),
        "untold": [any(x in text for text in result.unidentifiable) for x in case.free],
    }


def row(name: str, found: list[dict[str, Any]]) -> str:
    """A line of the table: coverage of the least and of all parameters, widths over the oracle's, what is open."""
    ends, truth, best, untold = (np.array([one[key] for one in found]) for key in ("ends", "truth", "oracle", "untold"))
    inside, width = (ends[..., 0] <= truth) & (truth <= ends[..., 1]), np.ptp(ends, axis=2)
    ratio, wrongly = np.median(np.median(width / best, axis=1)), untold & (best < 2.0 * truth)
    least = f"{inside.sum(axis=0).min()} of {len(found)}"
    return f"| {name} | {least} | {inside.mean():.1%} | {ratio:.2f} | {untold.sum()} | {wrongly.sum()} |"


def main() -> None:
    """Print the table, from outcomes that a file holds and those that are lacking there, which are added to it."""
    seeds, store = int(sys.argv[1]), Path(sys.argv[2])
    found = [json.loads(line) for line in store.read_text().splitlines()] if store.exists() else []
    have = {(one["kind"], one["seed"]) for one in found}
    cases = [(name, seed) for seed in range(seeds) for name in sys.argv[3:] or KINDS]
    with ProcessPoolExecutor(cores()) as pool, store.open("a") as file:
        for done in as_completed([pool.submit(outcome, *case) for case in cases if case not in have]):
            found.append(done.result())
            file.write(json.dumps(found[-1]) + "\n")
            file.flush()
    sys.stdout.write(
        "| kind | intervals that hold the truth, of the worst parameter | of all | width over the oracle's | "
        "called unidentifiable | of these told by the oracle |\n|---|---|---|---|---|---|\n"
    )
    for name in KINDS:
        if rows := [one for one in found if one["kind"] == name and one["seed"] < seeds]:
            sys.stdout.write(row(name, rows) + "\n")


if __name__ == "__main__":
    main()
