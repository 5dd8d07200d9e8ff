"""Children that work through the matrix: a few at a time, each in one environment, each entry once for each run."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

from .variants import LEVERS, Change, Environment

HERE = Path(__file__).resolve().parent
_LIMIT = 1800.0  # seconds for one answer: what takes longer hangs
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


class WorkerError(Exception):
    """A child ended, or never began; the message says how."""


@dataclass(frozen=True)
class Unit:
    """One run of one entry, and all the verdicts that are asked of it.

    Parameters
    ----------
    environment : Environment
        Machine code.
    name : str
        Of the entry.
    changes : tuple of Change
        Those that share the run.
    """

    environment: Environment
    name: str
    changes: tuple[Change, ...]


class Child:
    """A worker process in an environment.

    Parameters
    ----------
    environment : Environment
        Its machine code.
    caches : Path
        Folder for what numba compiles for other processors than the one at hand.

    Raises
    ------
    WorkerError
        If it does not begin.
    """

    def __init__(self, environment: Environment, caches: Path) -> None:
        variables = {name: value for name, value in os.environ.items() if name not in LEVERS}
        # the root of this checkout first: an installed flockana may be another one
        variables["PYTHONPATH"] = os.pathsep.join([str(HERE.parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])])
        variables |= dict.fromkeys(_ONE_THREAD, "1") | dict(environment.settings)
        if environment.code:
            variables["NUMBA_CACHE_DIR"] = str(caches / environment.code)
        self._errors: IO[str] = tempfile.TemporaryFile("w+", errors="replace")  # noqa: SIM115 - closed in close()
        self._process = subprocess.Popen(
            [sys.executable, str(HERE / "worker.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=variables,
            text=True,
            start_new_session=True,  # Ctrl-C is for the parent, which ends its children
        )
        self.environment = environment
        self.machine = self._answer()

    def ask(self, unit: Unit) -> dict[str, Any]:
        """Its outcomes of one run, by the name of the change.

        Parameters
        ----------
        unit : Unit
            What to do.

        Raises
        ------
        WorkerError
            If it ends instead of answering.
        """
        assert self._process.stdin is not None
        request = {"name": unit.name, "changes": {one.name: one.request() for one in unit.changes}}
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            raise self._ended() from None
        return self._answer()

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        watch = threading.Timer(_LIMIT, self.end)
        watch.daemon = True
        watch.start()
        line = self._process.stdout.readline()
        watch.cancel()
        if not line:
            raise self._ended()
        answer: dict[str, Any] = json.loads(line)
        return answer

    def _ended(self) -> WorkerError:
        code = self._process.wait()
        how = signal.Signals(-code).name if code < 0 else f"exit status {code}"
        self._errors.seek(0)
        last = (self._errors.read().strip().splitlines() or ["nothing said"])[-1]
        return WorkerError(f"the worker ended by {how}: {last}")

    def end(self) -> None:
        """End it at once; whoever waits for its answer is told so."""
        self._process.kill()

    def close(self) -> None:
        """End it, and let go of it."""
        self.end()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout, self._errors):
            if pipe is not None:
                pipe.close()


class _Queue:
    """Units by environment; whoever is done with one environment takes the next, or helps with the fullest."""

    def __init__(self, units: Iterable[Unit]) -> None:
        self._lock = threading.Lock()
        self._left: dict[Environment, deque[Unit]] = {}
        self._begun: set[Environment] = set()
        for unit in units:
            self._left.setdefault(unit.environment, deque()).append(unit)

    def take(self, own: Environment | None) -> Unit | None:
        """The next unit, of one's own environment if there is one; None when all is taken."""
        with self._lock:
            waiting = [one for one in self._left if self._left[one]]
            if not waiting:
                return None
            fresh = [one for one in waiting if one not in self._begun]
            fullest = max(waiting, key=lambda one: len(self._left[one]))
            chosen = own if own is not None and own in waiting else (*fresh, fullest)[0]
            self._begun.add(chosen)
            return self._left[chosen].popleft()

    def drop(self, environment: Environment | None = None) -> None:
        """Take nothing more, of one environment or of any."""
        with self._lock:
            for one in [environment] if environment else list(self._left):
                self._left[one].clear()


class Listener(Protocol):
    """Who is told what the children find; called from one thread at a time."""

    def unfit(self, environment: Environment, machine: Mapping[str, Any]) -> str:
        """Why an environment is of no use, by what a child in it tells of itself; empty if it is."""

    def skipped(self, environment: Environment, reason: str) -> None:
        """An environment is left out."""

    def found(self, unit: Unit, answer: Mapping[str, Any]) -> None:
        """A run and its verdicts."""


class _Crew:
    """Children at work, each in the hands of one thread."""

    def __init__(self, units: Iterable[Unit], listener: Listener, caches: Path) -> None:
        self._queue, self._listener, self._caches = _Queue(units), listener, caches
        self._telling = threading.Lock()
        self._children: set[Child] = set()
        self._stopped = False
        self.failures: list[BaseException] = []

    def work(self) -> None:
        """Of one thread: take units until there are none."""
        child: Child | None = None
        try:
            while unit := self._queue.take(child.environment if child else None):
                if child is None or child.environment != unit.environment:
                    self._dismiss(child)
                    child = self._begin(unit.environment)
                if child is not None:
                    child = self._carry_out(unit, child)
        except BaseException as error:
            self.failures.append(error)
            self._queue.drop()
        self._dismiss(child)

    def _begin(self, environment: Environment) -> Child | None:
        """A child in an environment, or none if it is of no use."""
        child = None
        try:
            child = Child(environment, self._caches)
            with self._telling:
                self._children.add(child)
                if self._stopped:  # while it began
                    child.end()
                reason = self._listener.unfit(environment, child.machine)
        except WorkerError as error:
            reason = str(error)
        if not reason:
            return child
        self._dismiss(child)
        self._queue.drop(environment)
        with self._telling:
            self._listener.skipped(environment, reason)
        return None

    def _carry_out(self, unit: Unit, child: Child) -> Child | None:
        """One unit; the child goes on unless it died of it."""
        left: Child | None = child
        try:
            answer = child.ask(unit)
        except WorkerError as error:
            if self._stopped:
                return None
            lost = {"run": str(error), "statuses": {}, "expected": {}}
            answer = {"outcomes": {one.name: lost for one in unit.changes}, "seconds": 0.0}
            self._dismiss(child)
            left = None
        with self._telling:
            self._listener.found(unit, answer)
        return left

    def _dismiss(self, child: Child | None) -> None:
        if child is not None:
            self._children.discard(child)
            child.close()

    def stop(self) -> None:
        """End all children; their threads let go of them and find nothing more to do."""
        self._stopped = True
        self._queue.drop()
        for child in list(self._children):
            child.end()


def carry_out(units: Iterable[Unit], listener: Listener, *, jobs: int, caches: Path | None = None) -> None:
    """Work through all units.

    Parameters
    ----------
    units : iterable of Unit
        What to do, environments in order.
    listener : Listener
        Who is told.
    jobs : int
        Children at a time.
    caches : Path, optional
        Folder for what numba compiles for other processors, each in one of its own; by default it is not kept.
    """
    with tempfile.TemporaryDirectory(prefix="portability-") as folder:
        crew = _Crew(units, listener, caches or Path(folder))
        threads = [threading.Thread(target=crew.work) for _ in range(jobs)]
        try:
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        finally:
            crew.stop()
            for thread in threads:
                thread.join()
    if crew.failures:
        raise crew.failures[0]
