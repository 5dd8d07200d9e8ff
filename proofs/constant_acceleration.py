"""Erratum E9: how far the MSN project's step moves an agent, by the library's own code on symbols."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import sympy as sp

from flockana.sources.isola_2024.laws import CONSTANT_ACCELERATION, PRINTED, MSNDiscretisation
from proofs.proof import Proof, Step

Q, P, U, DT, S = sp.symbols("q p u dt s")


def moved(factor: float) -> tuple[sp.Expr, sp.Expr]:
    """(q', p') after one step of the library's map under the input u, all agents at once."""
    law = SimpleNamespace(flow=lambda t, q, p: (U, 0.0))
    scheme = SimpleNamespace(law=law, dt=DT, in_place=False, position_factor=sp.Rational(factor))
    q, p, _, _ = MSNDiscretisation.step(scheme, sp.S.Zero, Q, P, {})  # type: ignore[arg-type]
    return q, p


def _steps() -> Iterator[Step]:
    true = Q + sp.integrate(P + U * S, (S, 0, DT))
    yield Step(
        "the printed update, v' = v + u dt and then q' = q + v' dt + ½ u dt², is the library's map",
        sp.expand(moved(PRINTED)[0] - (Q + (P + U * DT) * DT + U * DT**2 / 2)) == 0 and moved(PRINTED)[1] == P + U * DT,
        r"q' = q + v\,dt + \tfrac32 u\,dt^2",
    )
    yield Step(
        "under a constant u it goes u dt² too far",
        sp.expand(moved(PRINTED)[0] - true - U * DT**2) == 0,
        r"q(dt) = q + \int_0^{dt} (v + us)\,ds = q + v\,dt + \tfrac12 u\,dt^2",
    )
    yield Step(
        "with the velocity of the start of the step it is exact",
        sp.expand(moved(CONSTANT_ACCELERATION)[0] - true) == 0,
    )


PROOF = Proof(
    id="constant-acceleration",
    title="Erratum E9: the printed step goes u dt² too far",
    statement="v' = v + u dt, q' = q + v' dt + ½ u dt² is off by u dt² from the motion under a constant u.",
    hypotheses="u constant over the step; one agent, or all at once",
    rigour="symbolic",
    steps=_steps,
    size=3,
    theorems=("E9",),
)
