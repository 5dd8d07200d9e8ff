"""SQLite file of an ensemble's runs, safe against crashes of the program that writes it.

It is an SQLite file with a write-ahead log: a batch of runs is either in it or not, whenever the program is killed
(after a loss of power the last batches may be missing, none is torn), and several programs may write to it at once.
Like every such file it belongs on a local disk: write-ahead logs do not work on network file systems. The runs of a
cluster are written by the one program that asked for them.
"""

import json
import os
import sqlite3
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager

from flockana._version import __version__
from flockana.base.errors import FileError
from flockana.base.files import ensure_path, ensure_target
from flockana.ensemble.digest import numerics_version
from flockana.ensemble.one_run import COMPLETE, Record

FORMAT = 1
_MARK = 0x666C6F63  # "floc": tells our files from other SQLite files
_PATIENCE = 60.0  # seconds to wait for another writer
_AT_ONCE = 500  # keys in one query

_SCHEMA = (
    "CREATE TABLE IF NOT EXISTS facts (name TEXT PRIMARY KEY, value TEXT NOT NULL)",
    """CREATE TABLE IF NOT EXISTS runs (
        key TEXT PRIMARY KEY, scenario TEXT NOT NULL, seed INTEGER NOT NULL, options TEXT NOT NULL,
        status TEXT NOT NULL, record TEXT NOT NULL
    ) WITHOUT ROWID""",
    f"PRAGMA application_id = {_MARK}",
    f"PRAGMA user_version = {FORMAT}",
)
# a run that is there stays; only one that did not complete gives way to one that did
_INSERT = f"""INSERT INTO runs VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT (key) DO UPDATE
    SET status = excluded.status, record = excluded.record
    WHERE runs.status <> '{COMPLETE}' AND excluded.status = '{COMPLETE}'"""


class Store(AbstractContextManager["Store"]):
    """SQLite file of an ensemble's runs by key, used as a context manager."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = ensure_path(path, action="write")
        ensure_target(self.path)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            reason = error.strerror or error
            raise FileError(f"cannot make {self.path.parent}: {reason}; choose another folder") from error
        with self._explained():
            self._file = sqlite3.connect(self.path, timeout=_PATIENCE, isolation_level=None)
            try:
                self._open()
            except BaseException:
                self._file.close()
                raise

    def _open(self) -> None:
        tables = {name for (name,) in self._file.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        if tables and self._pragma("application_id") != _MARK:
            raise FileError(f"{self.path} is no store of flockana: choose another file")
        if self._pragma("user_version") > FORMAT:
            raise FileError(f"{self.path} is a store of a newer format: update flockana, or choose another file")
        if tables:
            if (fault := self._file.execute("PRAGMA quick_check(1)").fetchone()[0]) != "ok":
                raise sqlite3.DatabaseError(fault)
            self._ensure_version()
        self._prepare()
        with self._file:  # a second program may be doing the same: nothing is done twice
            for statement in ("BEGIN IMMEDIATE", *_SCHEMA):
                self._file.execute(statement)
            facts = (("mathematics", numerics_version()), ("flockana", __version__))
            self._file.executemany("INSERT OR IGNORE INTO facts VALUES (?, ?)", facts)
        self._ensure_version()

    def _pragma(self, name: str) -> int:
        return int(self._file.execute(f"PRAGMA {name}").fetchone()[0])

    def _prepare(self) -> None:
        """Switch SQLite to a write-ahead log, retrying while it is locked."""
        deadline = time.monotonic() + _PATIENCE
        while True:
            try:
                self._file.execute("PRAGMA journal_mode = WAL")
                self._file.execute("PRAGMA synchronous = NORMAL")
                return
            except sqlite3.OperationalError as error:
                if "locked" not in str(error) or time.monotonic() > deadline:
                    raise
                time.sleep(0.01)

    def _ensure_version(self) -> None:
        facts = dict(self._file.execute("SELECT name, value FROM facts"))
        if facts.get("mathematics") != numerics_version():
            raise FileError(
                f"{self.path} holds runs of another version of the mathematics ({facts.get('mathematics')}, flockana "
                f"{facts.get('flockana')}; this is {numerics_version()}, flockana {__version__}): choose another file, "
                "or compute with the flockana, numpy, scipy and numba that wrote it"
            )

    def __exit__(self, *error: object) -> None:
        self.close()

    def __len__(self) -> int:
        with self._explained():
            return int(self._file.execute("SELECT COUNT(*) FROM runs").fetchone()[0])

    def read(self, keys: Iterable[str]) -> dict[str, Record]:
        """Return the stored records of runs by key, as far as the given keys are stored."""
        keys_left, records = list(keys), {}
        with self._explained():
            for start_index in range(0, len(keys_left), _AT_ONCE):
                key_block = keys_left[start_index : start_index + _AT_ONCE]
                marks = ", ".join("?" * len(key_block))
                rows = self._file.execute(f"SELECT key, record FROM runs WHERE key IN ({marks})", key_block)
                for key, text in rows:
                    try:
                        records[key] = Record.from_json(text, key)
                    except (ValueError, KeyError, TypeError, AttributeError, FileError, RecursionError) as error:
                        raise sqlite3.DatabaseError(f"run {key[:8]} cannot be read, {error!r}") from error
        return records

    def add(self, scenario: str, records: Mapping[str, Record]) -> None:
        """Write runs in one transaction; runs already stored are kept."""
        rows = [
            (key, scenario, r.job.seed, json.dumps(dict(r.job.options)), r.status, r.to_json(key))
            for key, r in records.items()
        ]
        with self._explained(), self._file:
            self._file.execute("BEGIN IMMEDIATE")
            self._file.executemany(_INSERT, rows)

    def close(self) -> None:
        """Close the SQLite file of runs."""
        self._file.close()

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """Turn errors of SQLite into errors of flockana, with a remedy."""
        try:
            yield
        except sqlite3.OperationalError as error:
            raise FileError(
                f"cannot write {self.path}: {error}; choose a file on a local disk with room that you may write to"
            ) from error
        except sqlite3.DatabaseError as error:
            reason = " ".join(str(error).split())
            raise FileError(
                f"{self.path} is damaged or no store of flockana ({reason}); it was left as it is: move it away, or "
                "choose another file"
            ) from error
