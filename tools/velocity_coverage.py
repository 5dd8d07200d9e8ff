"""How often velocities from positions lie within their stated 95 %, by kinds of motion and of noise.

    python -m tools.velocity_coverage 200 outcomes.jsonl        # cases of each kind; kinds may follow

Outcomes are kept in the file, so that a run that was interrupted goes on.

Each case is one agent in the plane, at 80 samples of which 8 in a row are missing.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import flockana as fl
from flockana.recorded.velocities import motions

SAMPLES, MISSED, BESIDE = 80, 8, 4
Motion = Callable[[np.random.Generator, Any, int, float], tuple[Any, Any]]


def smooth(rng: np.random.Generator, t: Any, gap: int, _: float) -> tuple[Any, Any]:
    """Three waves on each axis, other ones elsewhere after the gap."""
    q, p, size = np.zeros((len(t), 2)), np.zeros((len(t), 2)), 10 ** rng.uniform(-2.0, 1.0)
    for part in (slice(0, gap), slice(gap, len(t))):
        a, w, f = rng.normal(size=(3, 2)), rng.uniform(0.3, 3.0, (3, 2)), rng.uniform(0.0, 6.3, (3, 2))
        phase = w * t[part, None, None] + f
        q[part] = (a / w * np.sin(phase)).sum(axis=1) + rng.normal(0.0, size, 2)
        p[part] = (a * np.cos(phase)).sum(axis=1)
    return q, p


def standing(rng: np.random.Generator, t: Any, gap: int, _: float) -> tuple[Any, Any]:
    """At rest, and at rest elsewhere after the gap."""
    q = np.where(np.arange(len(t))[:, None] < gap, rng.normal(size=2), rng.normal(size=2))
    return q, np.zeros(q.shape)


def straight(rng: np.random.Generator, t: Any, _: int, __: float) -> tuple[Any, Any]:
    """A straight line through the gap."""
    p = rng.normal(size=2) * 10 ** rng.uniform(-1.0, 1.0)
    return rng.normal(size=2) + p * t[:, None], np.broadcast_to(p, (len(t), 2))


def turning(rng: np.random.Generator, t: Any, gap: int, _: float) -> tuple[Any, Any]:
    """A straight line that turns by any angle in the middle of the gap."""
    p = np.stack([rng.normal(size=2), rng.normal(size=2)]) * 10 ** rng.uniform(-1.0, 1.0)
    s = t[:, None] - t[gap + MISSED // 2]
    return rng.normal(size=2) + np.where(s < 0.0, p[0] * s, p[1] * s), np.where(s < 0.0, p[0], p[1])


def bending(rng: np.random.Generator, t: Any, _: int, size: float) -> tuple[Any, Any]:
    """A line with a constant acceleration that bends it by 0.1 to 3 times the noise."""
    s, bend = (t - t.mean()) / np.ptp(t), size * 10 ** rng.uniform(-1.0, 0.5, 2) * rng.choice([-1.0, 1.0], 2)
    p = rng.normal(size=2)
    return p * t[:, None] + 4.0 * bend * s[:, None] ** 2, p + 8.0 * bend * s[:, None] / np.ptp(t)


NOISES = ("exact", "sd", "unknown", "bound", "rounded", "rounded unknown", "rounded sd")
TITLES = (
    "exact; sd stated; sd unknown; within a bound; rounded, bound stated; rounded, nothing stated; rounded, sd stated"
)
WAVES: dict[str, tuple[Motion, tuple[str, ...]]] = {
    f"waves, {title}": (smooth, (noise,)) for title, noise in zip(TITLES.split("; "), NOISES, strict=True)
}
KINDS: dict[str, tuple[Motion, tuple[str, ...]]] = {
    "standing": (standing, NOISES),
    "turning in the gap": (turning, NOISES),
    "straight": (straight, NOISES),
    "bending below the noise": (bending, NOISES[1:]),
    **WAVES,
}


def observed(rng: np.random.Generator, q: Any, noise: str, size: float) -> tuple[Any, dict[str, Any]]:
    """Return positions with noise, and the accuracy that is stated."""
    if noise.startswith("rounded"):
        stated = {"rounded": {"bound": size / np.sqrt(2.0)}, "rounded sd": {"sd": size / np.sqrt(12.0)}}
        return size * np.rint(q / size), stated.get(noise, {})
    if noise == "bound":
        return q + rng.uniform(-size, size, q.shape), {"bound": np.sqrt(2.0) * size}
    if noise == "exact":
        return q, {"bound": 0.0}
    return q + rng.normal(0.0, size, q.shape), {"sd": size} if noise == "sd" else {}


def outcome(kind: str, seed: int) -> dict[str, Any]:
    """Return the shares of velocities within their 95 %, of all seen samples and of those beside the gap."""
    rng, (motion, noises) = np.random.default_rng([list(KINDS).index(kind), seed]), KINDS[kind]
    noise = noises[seed % len(noises)]
    t: Any = np.arange(SAMPLES) * 10 ** rng.uniform(-1.7, -0.7)
    gap = int(rng.integers(8, SAMPLES - 8 - MISSED))
    size = 10 ** rng.uniform(-3.0, -0.7)
    q, p = motion(rng, t, gap, size)
    q, stated = observed(rng, q, noise, size)
    q[gap : gap + MISSED] = np.nan
    fit = motions(fl.Recording(t, q[:, None], **stated))
    inside = np.abs(fit.p[:, 0] - p) <= 1.96 * fit.p_sd + 1e-12 * (1.0 + np.abs(p))
    seen, beside = ~np.isnan(q[:, 0]), np.zeros(SAMPLES, dtype=bool)
    beside[gap - BESIDE : gap + MISSED + BESIDE] = True
    shares = {"all": float(inside[seen].mean()), "beside": float(inside[seen & beside].mean())}
    return {"kind": kind, "seed": seed, "noise": noise} | shares


def main() -> None:
    """Print the table, from outcomes that a file holds and those that are lacking there, which are added to it."""
    seeds, store = int(sys.argv[1]), Path(sys.argv[2])
    outcomes = [json.loads(line) for line in store.read_text().splitlines()] if store.exists() else []
    have = {(one["kind"], one["seed"]) for one in outcomes}
    for seed, kind in ((seed, kind) for seed in range(seeds) for kind in sys.argv[3:] or KINDS):
        if (kind, seed) not in have:
            outcomes.append(outcome(kind, seed))
            with store.open("a") as file:
                file.write(json.dumps(outcomes[-1]) + "\n")
    sys.stdout.write("| motion and noise | within 95 % | beside the gap | lowest case |\n|---|---|---|---|\n")
    for kind in KINDS:
        if rows := [one for one in outcomes if one["kind"] == kind and one["seed"] < seeds]:
            inside, beside = (np.array([one[key] for one in rows]) for key in ("all", "beside"))
            sys.stdout.write(f"| {kind} | {inside.mean():.1%} | {beside.mean():.1%} | {inside.min():.0%} |\n")


if __name__ == "__main__":
    main()
