import sqlite3
from pathlib import Path

import pytest

from flockana.base.errors import FileError
from flockana.ensemble import Store, ensemble, store
from flockana.ensemble.one_run import Job, Record
from tests.ensemble import tiny_flocks
from tests.ensemble.tiny_flocks import begun
from tests.programs import group, posix, program, until

ROOT = Path(__file__).parents[2]
CAMPAIGN = """
import sys
from tests.ensemble import tiny_flocks
from flockana.ensemble import ensemble
path, runs, jobs = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
found = ensemble(tiny_flocks.gated, range(runs), theorems=["source"], jobs=jobs, store=path)
print(found.order.values.tobytes().hex())
"""


def start(path, runs, jobs):
    """A campaign of gated runs; its log and its gate lie beside the store."""
    environment = {tiny_flocks.LOG: str(path.with_name("log")), tiny_flocks.GATE: str(path.with_name("gate"))}
    return program("-c", CAMPAIGN, path, runs, jobs, paths=[ROOT], environment=environment)


def seeds_in(path):
    with sqlite3.connect(path) as file:
        return sorted(seed for (seed,) in file.execute("SELECT seed FROM runs"))


def records(count, status="complete"):
    return {f"key {k}": Record(Job(k), status, metrics={"order": 0.1 + k}) for k in range(count)}


@pytest.mark.slow
@posix
def test_killed_in_mid_run_it_goes_on_with_what_is_missing(tmp_path, monkeypatch):
    """Both workers are held at the gate, with six runs or more in the store, when their parent is killed."""
    path, log, gate, runs = tmp_path / "s.sqlite", tmp_path / "log", tmp_path / "gate", 40
    with start(path, runs, 2) as victim:
        until(lambda: {seed for _, seed in begun(log)} & {*range(24, runs)} and len(seeds_in(path)) >= 6, victim)
        victim.kill()
        until(lambda: not group(victim))  # workers end with their parent, whatever they are at
    kept = seeds_in(path)
    assert 6 <= len(kept) == len({*kept}) < runs
    assert {*kept} <= {seed for _, seed in begun(log)}
    log.unlink()
    gate.touch()
    monkeypatch.setenv(tiny_flocks.LOG, str(log))
    monkeypatch.setenv(tiny_flocks.GATE, str(gate))
    again = ensemble(tiny_flocks.gated, range(runs), theorems=["source"], jobs=1, store=path)
    assert seeds_in(path) == list(range(runs))
    assert sorted(seed for _, seed in begun(log)) == sorted({*range(runs)} - {*kept})
    assert again.order.identical(ensemble(tiny_flocks.trio, range(runs), theorems=[], jobs=1).order)


@pytest.mark.slow
@posix
def test_two_writers_at_once_do_no_harm(tmp_path):
    """The gate opens when both are held at it: each of them still has runs to write."""
    path, log = tmp_path / "s.sqlite", tmp_path / "log"
    with start(path, 30, 1) as one, start(path, 30, 1) as other:
        until(lambda: len({process for process, seed in begun(log) if seed >= 24}) == 2, one, other)
        (tmp_path / "gate").touch()
        ends = [process.communicate() for process in (one, other)]
    assert [one.returncode, other.returncode] == [0, 0], ends
    assert ends[0][0] == ends[1][0]
    assert seeds_in(path) == list(range(30))
    with Store(path) as kept:
        assert len(kept) == 30


def test_what_is_stored_is_not_computed_again(tmp_path, monkeypatch):
    path, log = tmp_path / "new" / "s.sqlite", tmp_path / "log"
    monkeypatch.setenv(tiny_flocks.LOG, str(log))

    def computed(seeds, **options):
        log.unlink(missing_ok=True)
        found = ensemble(tiny_flocks.trio, seeds, theorems=["source"], jobs=1, store=path, **options)
        return [seed for _, seed in begun(log)], found

    assert computed(range(3))[0] == [0, 1, 2]
    more, wider = computed(range(2, 5))
    assert more == [3, 4]
    nothing, whole = computed([4, 0, 2])
    assert nothing == []
    assert whole.sel(seed=[2, 4]).identical(wider.sel(seed=[2, 4]))  # the stored time too
    assert computed(range(2), parameters={"n": 3})[0] == [0, 1]  # an option given is not one left out
    assert computed(range(2), parameters={"n": [3, 4]})[0] == [0, 1]
    assert computed([0], metrics=[])[0] == [0]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_failures_are_kept_until_a_retry(tmp_path, monkeypatch):
    path, log = tmp_path / "s.sqlite", tmp_path / "log"
    monkeypatch.setenv(tiny_flocks.LOG, str(log))
    given = {"theorems": ["source"], "metrics": ["order"], "jobs": 1, "store": path}
    first = ensemble(tiny_flocks.faulty, range(2, 6), **given)
    assert first.run.values.tolist() == [0, 2, 1, 0]
    log.unlink()
    assert first.identical(ensemble(tiny_flocks.faulty, range(2, 6), **given))
    assert not log.exists()
    ensemble(tiny_flocks.faulty, range(2, 6), **given, retry=True)
    assert [seed for _, seed in begun(log)] == [4]  # 3 raises before it is logged
    with Store(path) as kept:
        assert len(kept) == 4


def test_a_record_that_is_there_stays_and_a_failure_gives_way(tmp_path):
    with Store(tmp_path / "s.sqlite") as kept:
        kept.add("a", records(2))
        kept.add("a", {**records(3, "error"), "key 0": Record(Job(0), "complete", metrics={"order": 9.0})})
        assert kept.read(["key 0"])["key 0"].metrics["order"] == 0.1
        assert {key: one.status for key, one in kept.read(f"key {k}" for k in range(2000)).items()} == {
            "key 0": "complete",
            "key 1": "complete",
            "key 2": "error",
        }
        kept.add("a", {"key 2": Record(Job(2), "complete")})
        assert kept.read(["key 2"])["key 2"].status == "complete"


def test_numbers_come_back_to_the_bit(tmp_path):
    values = {"a": 0.1 + 0.2, "b": float("inf"), "c": -0.0, "d": 5e-324}
    one = Record(Job(2**62, (("n", 3), ("push", True), ("word", "ö"))), "complete", "", {}, {}, values, {"steps": 3})
    with Store(tmp_path / "s.sqlite") as kept:
        kept.add("a", {"k": one})
    with Store(tmp_path / "s.sqlite") as kept:
        found = kept.read(["k"])["k"]
    assert found == one
    assert [v.hex() for v in found.metrics.values()] == [v.hex() for v in values.values()]


@pytest.fixture
def whole(tmp_path):
    path = tmp_path / "s.sqlite"
    with Store(path) as kept:
        kept.add("a", records(3000))
    return path


def refused(path, message):
    before = path.read_bytes()
    with pytest.raises(FileError, match=message):
        Store(path)
    assert path.read_bytes() == before


def test_another_version_of_the_mathematics_is_refused(whole, monkeypatch):
    monkeypatch.setattr(store, "numerics_version", lambda: "0" * 16)
    refused(whole, r"another version of the mathematics .*this is 0{16}.*choose another file, or compute with")


def test_other_files_are_refused_and_left_alone(whole, tmp_path):
    with sqlite3.connect(whole) as file:
        file.execute("PRAGMA user_version = 2")
    file.close()
    refused(whole, "newer format: update flockana")
    other = tmp_path / "other.sqlite"
    with sqlite3.connect(other) as file:
        file.execute("CREATE TABLE mine (x)")
    file.close()
    refused(other, "is no store of flockana")
    text = tmp_path / "notes.txt"
    text.write_text("not a database\n" * 100)
    refused(text, r"damaged or no store of flockana \(file is not a database\)")


def test_a_damaged_store_is_told_and_left_alone(whole):
    data = bytearray(whole.read_bytes())
    data[4096 * 3 : -4096 * 3] = b"\xff" * (len(data) - 4096 * 6)
    whole.write_bytes(data)
    refused(whole, "is damaged .*it was left as it is: move it away")
    whole.write_bytes(data[:10000])
    refused(whole, "is damaged")


def test_a_record_that_cannot_be_read_is_told(whole):
    with sqlite3.connect(whole) as file:
        file.execute("UPDATE runs SET record = '{' WHERE seed = 7")
    file.close()
    with Store(whole) as kept, pytest.raises(FileError, match="run key 7 cannot be read"):
        kept.read(["key 7"])


def test_an_empty_file_is_a_new_store(tmp_path):
    (tmp_path / "s.sqlite").touch()
    with Store(tmp_path / "s.sqlite") as kept:
        assert len(kept) == 0


def test_where_nothing_can_be_written_is_told_before_any_work(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv(tiny_flocks.LOG, str(tmp_path / "log"))
    for path, message in ((tmp_path, "is a folder"), (tmp_path / "file" / "s.sqlite", "cannot make")):
        with pytest.raises(FileError, match=message):
            ensemble(tiny_flocks.trio, [0], jobs=1, store=path)
    assert not (tmp_path / "log").exists()


@pytest.mark.slow
def test_a_full_disk_is_told_and_nothing_is_torn(whole):
    with Store(whole) as kept:
        kept._file.execute("PRAGMA max_page_count = 1")  # SQLite raises it to the present size
        more = {f"more {k}": one for k, one in enumerate(records(3000).values())}
        with pytest.raises(FileError, match="full; choose a file on a local disk with room"):
            kept.add("a", more)
        assert len(kept) == 3000
