"""−k p·p never exceeds 0: a proof of one file."""

import sympy as sp

from proofs.proof import Proof, Step


def _steps():
    k, p = sp.Symbol("k", positive=True), sp.Symbol("p", real=True)
    yield Step("the power of the drag is not positive", bool((-k * p**2).is_nonpositive))


PROOF = Proof(id="toy-proof", statement="dH/dt <= 0", hypotheses="k > 0", rigour="symbolic", steps=_steps)
