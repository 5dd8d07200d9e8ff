"""Write the synthetic recording that is shipped: noise, gaps and an identity switch (`python tools/make_recording.py`).

Fourteen agents under Algorithm 2, a camera of 25 frames a time unit, noise of 0.05 in each coordinate. Each agent is
lost now and then for up to six frames, one for forty; two that are close change names for twelve frames.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from flockana import Algorithm2, StaticTarget, simulate

TARGET = Path(__file__).parent.parent / "flockana" / "recorded" / "data" / "synthetic.csv"
SEED, AGENTS, FRAMES, NOISE = 20, 14, 151, 0.05


def table() -> str:
    """The recording as a table of time, id, x, y."""
    rng = np.random.default_rng(SEED)
    q0 = 7.0 * np.stack(np.meshgrid(np.arange(7.0), np.arange(2.0)), axis=2).reshape(-1, 2)
    law = Algorithm2(target=StaticTarget((21.0, 3.5)))
    t = np.arange(FRAMES) / 25.0
    run = simulate(law, q0 + rng.normal(0.0, 0.7, q0.shape), rng.normal(0.0, 1.0, q0.shape), (0.0, t[-1]), t_eval=t)
    q = run.q + rng.normal(0.0, NOISE, run.q.shape)
    names = np.tile(np.arange(AGENTS), (FRAMES, 1))
    apart = np.linalg.norm(run.q[90, :, None] - run.q[90, None], axis=2) + 1e9 * np.eye(AGENTS)
    i, j = np.unravel_index(int(np.argmin(apart)), apart.shape)
    names[90:102, [i, j]] = names[90:102, [j, i]]
    seen = np.ones((FRAMES, AGENTS), dtype=bool)
    for agent in range(AGENTS):
        for start in rng.integers(5, FRAMES - 10, 2).tolist():
            seen[start : start + int(rng.integers(1, 7)), agent] = False
    seen[40:80, 5] = False
    rows = [
        f"{t[k]:.2f},bird{names[k, a]:02d},{q[k, a, 0]:.3f},{q[k, a, 1]:.3f}\n"
        for k in range(FRAMES)
        for a in range(AGENTS)
        if seen[k, a]
    ]
    return "time,id,x,y\n" + "".join(rows)


if __name__ == "__main__":
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_text(table(), encoding="utf-8")
    sys.stdout.write(f"written: {TARGET}\n")
