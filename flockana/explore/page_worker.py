"""Worker process of one page: answers the newest case and interrupts older ones."""

import _thread
import os
import signal
import threading
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection
from typing import Any

from flockana.base.interrupts import defer_sigint, restore_interrupts


class Worker:
    """Worker of one page: answers questions from a pipe; a newer question interrupts an older one."""

    def __init__(self, pipe: Connection, limit: float) -> None:
        self.pipe, self.limit = pipe, limit
        self.newest: tuple[int, Any] = (0, None)
        self.done = 0
        self.breakable = False  # not while a law is compiled for its first run: that would only begin again
        self.changed = threading.Condition()

    def read(self) -> None:
        """Receive the page's questions until the pipe closes."""
        while True:
            try:
                question = self.pipe.recv()
            except (EOFError, OSError):
                return
            with self.changed:
                self.newest = question
                self.changed.notify()
            if self.breakable:
                _thread.interrupt_main()

    def answer_all(self) -> None:
        """Answer the page's newest questions until the process ends."""
        from flockana.explore.case_answers import answer

        while True:
            with self.changed:
                self.changed.wait_for(lambda: self.newest[0] > self.done)
                number, data = self.newest
            try:
                self._send(number, "begun", {})
                with restore_interrupts():
                    send_answer, has_newer = partial(self._send, number), partial(self._newer_than, number)
                    answer(data, send_answer, limit=self.limit, cancelled=has_newer)
                self.done = number
            finally:
                self.breakable = False

    def _newer_than(self, number: int) -> bool:
        return self.newest[0] != number

    def _send(self, number: int, kind: str, content: Any) -> None:
        with defer_sigint():  # half a message would be the end of all
            self.pipe.send((number, kind, content))
        self.breakable = kind not in ("begun", "form", "done")
        if self._newer_than(number):  # it came before it could break anything off
            raise KeyboardInterrupt


def work(pipe: Connection, limit: float) -> None:
    """Answer an explorer page's questions in a worker process until its pipe closes."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    worker = Worker(pipe, limit)
    _warm()
    with suppress(BrokenPipeError):  # the server was ended, by force
        pipe.send((0, "ready", {}))
        threading.Thread(target=_read_to_the_end, args=(worker,), daemon=True).start()
        while True:
            with suppress(KeyboardInterrupt):  # a newer question, or one that came late: then the newest is asked again
                worker.answer_all()


def _read_to_the_end(worker: Worker) -> None:
    worker.read()
    os._exit(0)  # the server has ended: nobody waits for the answer


def _warm() -> None:
    """Load the modules and kernels that most answers need, before the first question."""
    from flockana.explore.case_answers import answer
    from flockana.explore.page_case import Case

    run_log: list[str] = []
    with suppress(KeyboardInterrupt):
        small_case = Case("law", "Algorithm2", n=12, duration=0.5)
        answer(small_case, lambda kind, content: run_log.append(kind), limit=60.0, cancelled=lambda: "ran" in run_log)
