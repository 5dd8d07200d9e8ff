import threading
import time
from contextlib import suppress
from multiprocessing import Pipe, get_context

import pytest

from flockana.explore import case_answers
from flockana.explore.page_worker import Worker, work


@pytest.fixture
def ask(monkeypatch, answering):
    """Answer questions as `script` says, which runs beside with the other end of the pipe; gives what it returned."""

    def answer(data, send, *, limit, cancelled):
        if data == "end":
            raise SystemExit
        send("form", {"data": data})
        if data == "deaf":  # nothing that may be broken off was begun
            while not cancelled():
                time.sleep(0.001)
        elif data == "slow":
            send("ran", {})
            while True:  # a solver that asks nobody
                time.sleep(0.001)
        send("done", {"data": data})

    def run(script):
        monkeypatch.setattr(case_answers, "answer", answer)
        mine, theirs = Pipe()
        worker, found = Worker(theirs, 60.0), []

        def play():
            found.append(script(mine))
            mine.send((99, "end"))

        for target in (worker.read, play):
            threading.Thread(target=target, daemon=True).start()
        with pytest.raises(SystemExit):
            answer_as_work_does(worker)
        mine.close()
        return found[0]

    return run


def answer_as_work_does(worker):
    while True:
        with suppress(KeyboardInterrupt):
            worker.answer_all()


def until(pipe, number, kind):
    """Everything up to a message."""
    found = []
    while not found or found[-1][:2] != (number, kind):
        assert pipe.poll(20.0)
        found.append(pipe.recv())
    return found


def test_one_after_the_other(ask):
    def script(pipe):
        pipe.send((1, "a"))
        first = until(pipe, 1, "done")
        pipe.send((2, "b"))
        return [*first, *until(pipe, 2, "done")]

    assert [(number, kind) for number, kind, _ in ask(script)] == [
        (number, kind) for number in (1, 2) for kind in ("begun", "form", "done")
    ]


@pytest.mark.parametrize("under_way", ["deaf", "slow"])
def test_a_newer_question_breaks_off_what_is_under_way(ask, under_way):
    def script(pipe):
        found = []
        for number in range(1, 40, 2):  # often: an interrupt that comes late must lose no question
            pipe.send((number, under_way))
            until(pipe, number, "ran" if under_way == "slow" else "form")
            pipe.send((number + 1, "quick"))
            found += until(pipe, number + 1, "done")
        return found

    found = ask(script)
    assert [each for each in found if each[1] == "done" and each[0] % 2] == [] or under_way == "deaf"
    assert [number for number, kind, _ in found if kind == "done" and number % 2 == 0] == list(range(2, 42, 2))


def started():
    """A process that works, and its pipe."""
    context = get_context("spawn")
    mine, theirs = context.Pipe()
    process = context.Process(target=work, args=(theirs, 60.0), daemon=True)
    process.start()
    theirs.close()
    return process, mine


@pytest.mark.slow
def test_a_process_of_its_own_answers_and_ends_with_the_server():
    """Four seconds: it is the only test that starts one without a browser."""
    process, mine = started()
    assert mine.poll(120.0)
    assert mine.recv() == (0, "ready", {})
    mine.send((1, {"kind": "law", "name": "Algorithm1", "n": 3, "duration": 0.1}))
    assert [kind for _, kind, _ in until(mine, 1, "ran")] == ["begun", "form", "run", "ran"]
    mine.close()
    process.join(60.0)
    assert process.exitcode == 0


@pytest.mark.slow
def test_where_the_server_is_ended_by_force_it_ends_without_a_word(capfd):
    process, mine = started()
    mine.close()  # before it says that it is ready
    process.join(120)
    assert (process.exitcode, capfd.readouterr().err) == (0, "")
