"""Scenarios of second-order consensus: rings on both sides of their threshold, nets with and without a root."""

import numpy as np

from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.yu_chen_cao_2010.laws import NetConsensus

_AGREES = verified("net-consensus", "net-consensus:consensus") | vacuous("net-consensus:some-start")
_NEVER = vacuous("net-consensus:consensus") | verified("net-consensus", "net-consensus:some-start")


def _net(name: str, title: str, law: NetConsensus, expected: dict[str, Status], span: float = 40.0) -> Builder:
    """Return the builder of a scenario of agents on a given net with a random start."""
    source = f"Ours, on Ren and Atkins: u = -L(αq + βp), α = {law.position:g}, β = {law.velocity:g}; a random start."

    def draw(seed: int) -> Start:
        generator = np.random.default_rng(seed)
        shape = (len(law.weights), 2)
        return generator.uniform(-1.0, 1.0, shape), generator.uniform(-1.0, 1.0, shape)

    return entry(name, title, source, law, draw, span, expected, references=("ren-atkins-2007", "flockana"))


def _ring(n: int) -> np.ndarray:
    """Return the weights of a directed ring: each agent hears the next."""
    return np.roll(np.eye(n), 1, axis=1)


_PARTED = np.kron(np.eye(2), np.ones((2, 2)) - np.eye(2))
SCENARIOS = {
    "net-ring-above": _net(
        "net-ring-above", "A directed ring of four, damped enough", NetConsensus(_ring(4), 2.0, 1.1), _AGREES
    ),
    "net-ring-at": _net(
        "net-ring-at", "A directed ring of four at its threshold", NetConsensus(_ring(4), 2.0, 1.0), _NEVER
    ),
    "net-ring-below": _net(
        "net-ring-below", "A directed ring of six, damped too little", NetConsensus(_ring(6), 1.0, 1.2), _NEVER
    ),
    "net-chain": _net(
        "net-chain", "A chain of five that hears its leader", NetConsensus(np.eye(5, k=-1), 1.0, 0.5), _AGREES, 120.0
    ),
    "net-parted": _net("net-parted", "Two pairs that do not hear each other", NetConsensus(_PARTED), _NEVER),
}
