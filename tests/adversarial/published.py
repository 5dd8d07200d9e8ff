"""What is printed of theorems that need no run, and of short runs of the catalogue: a change of it must be meant.

Number by number in `published.json`; of runs in `published_runs.json`, whose margins may be off by their own errors.
`python -m tests.adversarial.published` writes both anew.
"""

import json
import re
from functools import cache
from itertools import zip_longest
from math import isfinite, isinf, isnan
from pathlib import Path

from flockana.theorems import theorem, theorems, verify

_FILE = Path(__file__).with_suffix(".json")
_RUNS = Path(__file__).with_name("published_runs.json")
LONG = 1.2  # seconds: a run and its verdicts that take longer are left to `flockana verify`
ROUNDED = ("gamma-system",)  # runs whose errors at the end are rounding's, of another size on every processor
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SAME, _ERROR, _PRINTED = 1e-4, 0.05, 0.02  # relative: integrators and BLAS differ between processors by less
_NOISE, _TIMES = 1e-7, 100.0  # what is below may come from rounding alone, and be so many times as large,
_NOTHING = 1e-14  # or nothing at all
_OF_RUN = 1e-3  # relative, of a margin beyond the errors


def data_of(verdict):
    """What a verdict says, as plain data."""
    kept = "by status rigour proof disproof computed stated margin error witness detail"
    return {claim["name"]: {k: claim[k] for k in kept.split()} for claim in verdict.to_dict()["claims"]}


@cache
def _published():
    return json.loads(_FILE.read_text("utf-8"))


@cache
def published_runs():
    """Verdicts of scenarios, by name and by theorem."""
    return json.loads(_RUNS.read_text("utf-8"))


def changes_of_run(name, verdicts):
    """Where margins are off what was published by more than their errors, errors are of another size, or what was
    computed is another number or text.
    """
    was, now = published_runs()[name], {verdict.theorem: _said_of_run(verdict) for verdict in verdicts}
    if was.keys() != now.keys() or any(was[key].keys() != now[key].keys() for key in was):
        return [f"{name}: other claims or hypotheses than published"]
    return [
        f"{name}/{theorem}/{what}: {before} is now {after}"
        for theorem, said in was.items()
        for what, before in said.items()
        if not _as_published(before, after := now[theorem][what])
    ]


def _said_of_run(verdict):
    """Status and margin of each hypothesis; of each claim its error, its value, and how it is known."""
    said = verdict.to_dict()
    needs = {need["name"]: [need["status"], need["margin"]] for need in said["hypotheses"]}
    kept = ("status", "margin", "error", "computed", "rigour", "proof", "disproof")
    return needs | {claim["name"]: [claim[key] for key in kept] for claim in said["claims"]}


def _as_published(before, after):
    (status, margin, *more), (found, other, *rest) = before, after
    if not more:
        return status == found and near(number(margin), number(other), 0.0, 0.0)
    (error, computed, *known), (own, new, *how) = more, rest
    return (
        (status, known) == (found, how)
        and near(number(margin), number(other), number(error), number(own))
        and _same_of_run(computed, new, max(number(error), number(own)))
    )


def _same_of_run(was, now, error):
    """Whether what was computed is the same but for integration and rounding."""
    if isinstance(was, int | float) and isinstance(now, int | float):
        return near(float(was), float(now), error, error) or _close(was, now, _OF_RUN)
    return not list(differences("", was, now))


def number(x):
    """One of a verdict's numbers as it is written; NaN where there is none."""
    return float("nan") if x is None else float(x)


def near(margin, other, error, own):
    """Whether two margins of runs, with their errors, are the same but for integration and rounding."""
    if isnan(margin) or isnan(other) or isinf(margin) or isinf(other):
        same = (isnan(margin) and isnan(other)) or margin == other
    else:
        slack = sum(x for x in (error, own) if isfinite(x))
        same = abs(margin - other) <= slack + _OF_RUN * max(abs(margin), abs(other)) + _NOTHING
    if not (isfinite(error) and isfinite(own)):
        return same and (error == own or (isnan(error) and isnan(own)))
    return same and (max(error, own) < _NOTHING or max(error, own) <= _TIMES * min(error, own))


def changes(verdict):
    """Where a verdict is not what was published, one line each."""
    return list(differences(verdict.theorem, _published().get(verdict.theorem), data_of(verdict)))


def differences(path, was, now):
    """Where two verdicts differ by more than rounding, one line each."""
    if isinstance(was, dict) and isinstance(now, dict):
        for key in {**was, **now}:
            yield from differences(f"{path}/{key}", was.get(key), now.get(key))
    elif isinstance(was, list) and isinstance(now, list):
        for k, pair in enumerate(zip_longest(was, now)):
            yield from differences(f"{path}/{k}", *pair)
    elif not alike(path, was, now):
        yield f"{path}: {was!r} is now {now!r}"


def alike(path, was, now):
    """Whether two values are the same but for rounding; texts word by word, and number by number."""
    if isinstance(was, str) and isinstance(now, str):
        numbers = [tuple(map(float, pair)) for pair in zip(_NUMBER.findall(was), _NUMBER.findall(now), strict=False)]
        plain = _NUMBER.sub("#", was) == _NUMBER.sub("#", now)
        return plain and all(_close(a, b, _PRINTED) or max(abs(a), abs(b)) < _NOISE for a, b in numbers)
    if isinstance(was, bool | None) or isinstance(now, bool | None) or not {type(was), type(now)} <= {int, float}:
        return was == now
    return _close(was, now, _ERROR if "error" in path.rsplit("/", 1)[-1] else _SAME)


def _close(was, now, share):
    large, small = max(abs(was), abs(now)), min(abs(was), abs(now))
    rounded = was * now >= 0.0 and large < _NOISE and large <= _TIMES * small
    return abs(was - now) <= share * large or rounded or large < _NOTHING


def write():
    """Write both files; a run that is published stays so on a slower machine."""
    from time import process_time

    from flockana.scenarios import scenario, scenarios

    before = published_runs() if _RUNS.exists() else {}
    fixed = {name: data_of(verify(name)) for name in theorems() if theorem(name).kind == "fixed"}
    runs = {}
    for name in scenarios():
        entry = scenario(name)
        entry.verify(entry.run())  # compiled and loaded from here on
        start = process_time()
        verdicts = entry.verify(entry.run())
        if (name in before or process_time() - start <= LONG) and name not in ROUNDED:
            runs[name] = {verdict.theorem: _said_of_run(verdict) for verdict in verdicts}
    for file, data in ((_FILE, fixed), (_RUNS, runs)):
        file.write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    write()
