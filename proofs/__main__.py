"""Run every proof, print what was proved; exit status 0 if all hold, 3 if one does not."""

from __future__ import annotations

import sys
import time

from proofs.proof import proofs


def main() -> int:
    """Check all steps of all proofs."""
    failed = 0
    for proof in proofs():
        started = time.perf_counter()
        steps = list(proof.steps())
        broken = [step.text for step in steps if not step.holds]
        failed += bool(broken)
        outcome = f"{len(steps)} steps hold" if not broken else f"FAILS at: {'; '.join(broken)}"
        print(f"{proof.id} ({proof.rigour}, {time.perf_counter() - started:.1f} s): {outcome}")
        print(f"  {proof.statement}\n  given {proof.hypotheses}")
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
