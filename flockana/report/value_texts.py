"""Values as short text, for the page and for the terminal."""

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from inspect import getdoc
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from flockana.theorems import Claim, Tolerances, Verdict

MARKS = {"verified": "✓", "refuted": "✗", "vacuous": "∅", "inconclusive": "?"}
_LONGEST = 6  # entries of a sequence that are written out
_GAIN_OWNERS = {"alpha": "alpha", "beta": "beta", "gamma": "target"}  # suffix of a gain: the law's field it acts by


def show(value: Any) -> str:
    """Return a claim's value as short text: numbers to four digits, long sequences by length."""
    if value is None:
        return "—"
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, bool | str | int):
        return str(value)
    if isinstance(value, float):
        return f"{value + 0.0:.4g}"  # + 0.0 drops the sign of a negative zero
    if isinstance(value, Mapping):
        items = ((key, f"({show(item)})" if isinstance(item, Mapping) else show(item)) for key, item in value.items())
        return "; ".join(f"{key}: {text}" for key, text in items)
    if isinstance(value, list | tuple):
        if len(value) > _LONGEST:
            return f"{len(value)} values"
        return f"({', '.join(show(item) for item in value)})"
    return str(value)


def markup(value: Any) -> Markup:
    """Return a value as markup: short text, or a folded table of nested mappings."""
    if not isinstance(value, Mapping) or (len(value) <= _LONGEST and not any(map(_deep, value.values()))):
        return escape(show(value))
    rows = Markup("").join(Markup("<dt>{}</dt><dd>{}</dd>").format(key, markup(item)) for key, item in value.items())
    count = "1 entry" if len(value) == 1 else f"{len(value)} entries"
    return Markup('<details class="values"><summary>{}</summary><dl>{}</dl></details>').format(count, rows)


def _deep(value: Any) -> bool:
    return isinstance(value, Mapping) or (isinstance(value, list | tuple) and any(map(_deep, value)))


def source_name(key: str) -> str:
    """Return a key of the bibliography as a readable name."""
    *words, year = key.split("-") if key[-1:].isdigit() else (*key.split("-"), "")
    return f"{'-'.join(word.upper() if word in ('msn', 'ode') else word.capitalize() for word in words)} {year}".strip()


def deciding_claim(verdict: Verdict) -> Claim | None:
    """Return the first of the author's claims with the verdict's own status, or None."""
    return next((claim for claim in verdict.main_claims if claim.status == verdict.status), None)


def parameters(law: Any) -> tuple[tuple[str, str], ...]:
    """Return a law's parameters as readable (name, value) pairs, without unused gains."""
    if not is_dataclass(law):
        return (("law", type(law).__name__),)
    items = ((f.name, getattr(law, f.name)) for f in fields(law))
    return (("law", type(law).__name__), *((name, _describe(value, law)) for name, value in items))


def _describe(value: Any, law: Any) -> str:
    if not is_dataclass(value):
        return getattr(value, "__name__", None) or show(value)
    values = []
    for f in fields(value):
        owner = _GAIN_OWNERS.get(f.name.rpartition("_")[2]) if f.name.startswith(("c1_", "c2_")) else None
        if owner is None or getattr(law, owner, None) is not None:
            values.append(f"{f.name} = {_describe(getattr(value, f.name), law)}")
    return f"{type(value).__name__}({', '.join(values)})"


def tolerance_rows(tolerances: Tolerances) -> tuple[tuple[str, str, str], ...]:
    """Return (name, value, meaning) of every numeric threshold of the verdicts."""
    meanings = dict(re.findall(r"^(\w+) : float\n((?:[ ]{4}.+\n?)+)", getdoc(Tolerances) or "", re.MULTILINE))
    names = [f.name for f in fields(tolerances)]
    return tuple((n, show(getattr(tolerances, n)), " ".join(meanings.get(n, "").split())) for n in names)
