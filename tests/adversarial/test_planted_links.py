"""Links that a tension keeps: chains and stars thrown apart in any unit, and nets in several parts."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana.sources.zavlanos_2007.laws import LinkKeeping
from tests.adversarial.cases import TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import seeds

THEOREMS = ("links-kept",)
CLAIMS = dict.fromkeys(("rate", "balance", "links", "connected", "velocities"), TRUE)


@st.composite
def nets(draw):
    """A tree, or one without one of its links, at random speeds: up to what stretches links to 0.99 r."""
    rng, n = np.random.default_rng(draw(seeds)), draw(st.integers(2, 6))
    L, T = draw(st.sampled_from(((1.0, 1.0), (1e-3, 1.0), (1e3, 60.0))))
    parents = [int(rng.integers(k)) for k in range(1, n)]
    q = np.zeros((n, 2))
    for k, parent in enumerate(parents, start=1):
        angle = rng.uniform(0.0, 2.0 * np.pi)
        q[k] = q[parent] + rng.uniform(0.1, 0.9) * np.array([np.cos(angle), np.sin(angle)])
    links = [(parent, k) for k, parent in enumerate(parents, start=1)]
    joined = draw(st.booleans()) or n == 2
    p = draw(st.sampled_from((0.0, 0.5, 3.0))) * rng.normal(size=(n, 2))
    c = draw(st.sampled_from((0.0, 1.0)))
    law = LinkKeeping(tuple(links if joined else links[1:]), r=L, k=L / T**2, c=c / T)
    return Case(law, L * q, L / T * p, 2.0 * T), joined


@effort(0.2)
@given(nets())
def test_no_link_is_lost(drawn):
    case, joined = drawn
    said = CLAIMS if joined else CLAIMS | {"connected": VACUOUS, "velocities": VACUOUS}
    hold("links-kept", case, said | {"velocities": VERIFIED if joined and case.law.c > 0.0 else VACUOUS})
