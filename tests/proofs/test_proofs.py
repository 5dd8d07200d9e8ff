"""Every proof holds, step by step, and a claim that names a proof names one that exists."""

from __future__ import annotations

import pytest

from flockana.theorems import verify
from proofs.proof import Proof, Step, proofs

ALL = {proof.id: proof for proof in proofs()}


@pytest.mark.parametrize("name", ALL)
def test_every_step_holds(name):
    steps = list(ALL[name].steps())
    assert len(steps) >= 3
    assert [step.text for step in steps if not step.holds] == []


@pytest.mark.parametrize("erratum", ["E1", "E2"])
def test_claims_name_proofs_that_exist(erratum):
    named = {claim.proof for claim in verify(erratum).claims if claim.proof}
    assert named
    assert named <= set(ALL)


def test_a_broken_step_fails_the_run(monkeypatch, capsys):
    from proofs import __main__ as runner

    broken = Proof("x", "two is three", "nothing", "symbolic", lambda: iter([Step("2 = 3", False)]))
    monkeypatch.setattr(runner, "proofs", lambda: (broken,))
    assert runner.main() == 3
    assert "FAILS at: 2 = 3" in capsys.readouterr().out
