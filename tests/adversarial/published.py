"""What is printed of theorems that need no run, number by number, in `published.json`: a change of it must be meant.

`python -m tests.adversarial.published` writes the file anew.
"""

from __future__ import annotations

import json
import re
from functools import cache
from itertools import zip_longest
from pathlib import Path

_FILE = Path(__file__).with_suffix(".json")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SAME, _ERROR, _PRINTED = 1e-4, 0.05, 0.02  # relative: integrators and BLAS differ between processors by less
_NOISE, _TIMES = 1e-7, 30.0  # what is below may come from rounding alone, and be so many times as large,
_NOTHING = 1e-14  # or nothing at all


def data_of(verdict):
    """What a verdict says, as plain data."""
    kept = ("name", "status", "rigour", "computed", "stated", "margin", "error", "witness", "detail")
    return {claim.pop("name"): claim for claim in ({k: c[k] for k in kept} for c in verdict.to_dict()["claims"])}


@cache
def _published():
    return json.loads(_FILE.read_text("utf-8"))


def changes(verdict):
    """Where a verdict is not what was published, one line each."""
    return list(_changes(verdict.theorem, _published().get(verdict.theorem), data_of(verdict)))


def _changes(path, was, now):
    if isinstance(was, dict) and isinstance(now, dict):
        for key in {**was, **now}:
            yield from _changes(f"{path}/{key}", was.get(key), now.get(key))
    elif isinstance(was, list) and isinstance(now, list):
        for k, pair in enumerate(zip_longest(was, now)):
            yield from _changes(f"{path}/{k}", *pair)
    elif not _alike(path, was, now):
        yield f"{path}: {was!r} is now {now!r}"


def _alike(path, was, now):
    if isinstance(was, str) and isinstance(now, str):
        numbers = zip(_NUMBER.findall(was), _NUMBER.findall(now), strict=False)
        plain = _NUMBER.sub("#", was) == _NUMBER.sub("#", now)
        return plain and all(_close(float(a), float(b), _PRINTED) for a, b in numbers)
    if isinstance(was, bool | None) or isinstance(now, bool | None) or not {type(was), type(now)} <= {int, float}:
        return was == now
    return _close(was, now, _ERROR if "error" in path.rsplit("/", 1)[-1] else _SAME)


def _close(was, now, share):
    large, small = max(abs(was), abs(now)), min(abs(was), abs(now))
    rounded = was * now >= 0.0 and large < _NOISE and large <= _TIMES * small
    return abs(was - now) <= share * large or rounded or large < _NOTHING


def write():
    """Write the file."""
    from flockana.theorems import theorem, theorems, verify

    said = {name: data_of(verify(name)) for name in theorems() if theorem(name).kind == "fixed"}
    _FILE.write_text(json.dumps(said, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    write()
