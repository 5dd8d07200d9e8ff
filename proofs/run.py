"""Check proofs, each in a process of its own: one that hangs is killed, and what was not checked is `unknown`."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any

from flockana.base.interrupts import block_sigint, defer_sigint
from proofs.proof import Proof, Step, load

START_LIMIT = 300.0  # seconds to import a proof in; only then its own limit begins
LIBRARIES = {"flint": "python-flint", "z3": "z3-solver"}
_TOLD = ("title", "statement", "hypotheses", "rigour", "theorems", "time_limit", "size", "values")


@dataclass
class Outcome:
    """What came of a proof: the steps that were checked, and why there are no more, if there should be."""

    id: str
    title: str = ""
    statement: str = ""
    hypotheses: str = ""
    rigour: str = ""
    theorems: tuple[str, ...] = ()
    time_limit: float = START_LIMIT
    steps: list[Step] = field(default_factory=list)
    seconds: float = 0.0
    reason: str = ""
    size: int | None = None
    values: Mapping[str, str] = field(default_factory=dict)

    @property
    def status(self) -> str:
        """``"failed"`` if a step or a stated number is false, ``"proved"`` if all hold, else ``"unknown"``."""
        if any(step.holds is False for step in self.steps) or any(self.misprints()):
            return "failed"
        found = {name for step in self.steps for name in step.found}
        complete = self.steps and not self.reason and self.size in (None, len(self.steps)) and set(self.values) <= found
        return "proved" if complete and all(step.holds for step in self.steps) else "unknown"

    def misprints(self) -> Iterator[str]:
        """Numbers of the statement that are not those that the steps found."""
        for step in self.steps:
            for name, value in step.found.items():
                if self.values.get(name) != value:
                    yield f"{name} is {value}, and not {self.values.get(name)} as stated"

    def objections(self) -> Iterator[str]:
        """All that keeps it from being proved, in words."""
        for step in self.steps:
            if not step.holds:
                what = "could not tell" if step.holds is None else "does not hold"
                yield f"{what}: {step.text}" + (f" ({step.evidence})" if step.evidence else "")
        yield from self.misprints()
        if self.reason or not self.steps:
            yield self.reason or "it has no steps"
        elif self.size not in (None, len(self.steps)):
            yield f"{len(self.steps)} steps were checked: expected {self.size}"
        else:
            for name in self.values.keys() - {name for step in self.steps for name in step.found}:
                yield f"no step finds {name}, stated as {self.values[name]}"


def check(
    wanted: Sequence[str],
    *,
    jobs: int = 1,
    time_limit: float | None = None,
    package: str = "proofs",
    watch: Callable[[tuple[str, ...]], None] = lambda under_way: None,
) -> Iterator[Outcome]:
    """Check the proofs of these ids, so many at a time; yield each outcome as it comes.

    `time_limit` in seconds replaces the proofs' own, and like these counts from when a proof is imported; `watch` is
    told what is under way.
    """
    waiting, running = list(wanted), list[_Run]()
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                with defer_sigint(), block_sigint():  # no child gets it, and none is missing from the list
                    running.append(_Run(waiting.pop(0), package, time_limit))
            watch(tuple(run.outcome.id for run in running))
            wait([run.pipe for run in running], max(0.0, min(run.deadline for run in running) - time.monotonic()))
            for run in [run for run in running if run.over()]:
                running.remove(run)
                yield run.outcome
    finally:
        with defer_sigint():
            for run in running:
                run.end()


class _Run:
    """A proof under way in another process, which sends what it is, its steps, and at last why it ended."""

    def __init__(self, name: str, package: str, time_limit: float | None) -> None:
        context = get_context("spawn")
        self.pipe, far_end = context.Pipe(duplex=False)
        self.process: BaseProcess = context.Process(target=_work, args=(name, package, far_end), daemon=True)
        self.outcome, self.limit = Outcome(name), time_limit
        self.started = self.since = time.monotonic()
        self.allowed = START_LIMIT
        self.process.start()
        far_end.close()

    @property
    def deadline(self) -> float:
        """When to kill it."""
        return self.since + self.allowed

    def over(self) -> bool:
        """Take what was sent; whether the process ended or its time is up, and then the outcome is complete."""
        outcome = self.outcome
        try:
            while self.pipe.poll():
                kind, told = self.pipe.recv()
                if kind == "step":
                    outcome.steps.append(told)
                elif kind == "proof":
                    vars(outcome).update(told)
                    self.since = time.monotonic()
                    self.allowed = outcome.time_limit if self.limit is None else self.limit
                else:
                    outcome.reason = told
                    return self.end()
        except (EOFError, OSError):  # between two messages, or within one
            self.process.join(5.0)
            outcome.reason = f"its process ended before the proof did (exit code {self.process.exitcode})"
            return self.end()
        if time.monotonic() < self.deadline:
            return False
        outcome.reason = f"stopped after {self.allowed:g} s, with {len(outcome.steps)} steps checked"
        return self.end()

    def end(self) -> bool:
        """Leave nothing behind."""
        self.outcome.seconds = time.monotonic() - self.started
        self.process.kill()
        self.process.join()
        self.pipe.close()
        return True


def _work(name: str, package: str, pipe: Connection) -> None:
    """In the other process: check the steps and send them, each as soon as it is checked."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then kills this
    try:
        proof = load(name, package)
        pipe.send(("proof", _told(proof)))
        for step in proof.steps():
            holds = None if step.holds is None else bool(step.holds)
            pipe.send(("step", Step(step.text, holds, str(step.latex), str(step.evidence), dict(step.found))))
        reason = ""
    except ImportError as error:
        library = LIBRARIES.get((error.name or "").partition(".")[0])
        remedy = f"{library} is not installed: pip install 'flockana[proofs]'"
        reason = remedy if library else f"stopped by {type(error).__name__}: {error}"
    except Exception as error:  # a fault of the proof, not of the theorem
        reason = f"stopped by {type(error).__name__}: {error}"
    with suppress(BrokenPipeError):  # nobody is there any more to be told
        pipe.send(("end", reason))


def _told(proof: Proof) -> dict[str, Any]:
    return {name: getattr(proof, name) for name in _TOLD} | {"values": dict(proof.values)}
