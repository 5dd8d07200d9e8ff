"""What came of the matrix: outcomes by variant and entry, and the rows in which one differs from another."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from .crew import Unit
from .variants import NATIVE, Environment, no_effect

MISSING = "missing"


@dataclass(frozen=True)
class Row:
    """One claim of one entry that came out otherwise.

    Parameters
    ----------
    scenario, theorem, claim, variant : str
        Which; no claim where a verdict as a whole was expected to be something else.
    there, here : str
        Status in the variant, and on the machine as it is.
    expected : str
        What the catalogue expects; empty if it expects nothing.
    """

    scenario: str
    theorem: str
    claim: str
    variant: str
    there: str
    here: str
    expected: str


def differences(
    name: str, variant: str, there: Mapping[str, Any], here: Mapping[str, Any], *, share: float | None = None
) -> Iterator[Row]:
    """Rows for one entry: claims that differ from those of the machine as it is, and from the expected.

    Parameters
    ----------
    name, variant : str
        Of the entry and the variant.
    there, here : mapping
        Outcomes in the variant and on the machine as it is.
    share : float, optional
        Of the tolerance that the residual of the energy balance may use.
    """
    if there["run"] != here["run"] or there["run"] != "complete":
        yield Row(name, "", "run", variant, there["run"], here["run"], "complete")
    expected = there["expected"] if there["statuses"] else here["expected"]
    keys = dict.fromkeys([*here["statuses"], *there["statuses"], *expected])
    for key in keys if there["statuses"] and here["statuses"] else ():  # the row above says it all
        one, other, wanted = there["statuses"].get(key, MISSING), here["statuses"].get(key, MISSING), expected.get(key)
        theorem, _, claim = key.partition(":")
        # a verdict as a whole follows from its claims: it is told where it is expected
        if (one != other and (claim or wanted)) or (wanted and one != wanted):
            yield Row(name, theorem, claim, variant, one, other, wanted or "")
    residual = there.get("residual")
    if share is not None and residual is not None and not residual <= share:  # NaN is too much as well
        own = here.get("residual")
        beside = "none" if own is None else f"{own:.2g}"
        yield Row(name, "", "energy residual", variant, f"{residual:.2g}", beside, f"<= {share:g}")


@dataclass
class Findings:
    """Outcomes as they come.

    Parameters
    ----------
    native : mapping
        What a child tells of the machine as it is.
    planned : Counter of str
        Number of entries by variant.
    """

    native: Mapping[str, Any]
    planned: Counter[str]
    machines: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    outcomes: dict[str, dict[str, Mapping[str, Any]]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def unfit(self, environment: Environment, machine: Mapping[str, Any]) -> str:
        """Why an environment is of no use; empty if it is."""
        self.machines[environment.name] = machine
        return "" if environment.name == NATIVE else no_effect(environment, self.native, machine)

    def skipped(self, environment: Environment, reason: str) -> None:
        """Remember it, and say so once."""
        if environment.name not in self.left_out:
            sys.stderr.write(f"{environment.name} is left out: {reason}\n")
        self.left_out[environment.name] = reason

    def found(self, unit: Unit, answer: Mapping[str, Any]) -> None:
        """Keep the outcomes of a run, and say what is complete."""
        for change in unit.changes:
            # machine code and changes are not combined: one of the two has the name of the machine as it is
            variant = unit.environment.name if change.name == NATIVE else change.name
            kept = self.outcomes.setdefault(variant, {})
            kept[unit.name] = answer["outcomes"].get(change.name)
            self.seconds[variant] = self.seconds.get(variant, 0.0) + answer["seconds"] / len(unit.changes)
            if len(kept) == self.planned[variant]:
                sys.stderr.write(f"{variant}: {len(kept)} entries, {self.seconds[variant]:.0f} CPU-s\n")

    def rows(self, variants: Sequence[str], *, share: float | None = None) -> list[Row]:
        """Everything that differs, by variant in the order given.

        Parameters
        ----------
        variants : sequence of str
            Names.
        share : float, optional
            Of the tolerance that the residual of the energy balance may use.
        """
        here = self.outcomes.get(NATIVE, {})
        return [
            row
            for variant in variants
            for name, there in sorted(self.outcomes.get(variant, {}).items())
            if there is not None and name in here
            for row in differences(name, variant, there, here[name], share=share)
        ]

    def to_dict(self, rows: Sequence[Row]) -> dict[str, Any]:
        """Plain data for JSON: machines, what was left out, all statuses, and the rows."""
        return {
            "machines": {
                name: {k: m[k] for k in ("openblas", "libm", "numba", "numpy")} for name, m in self.machines.items()
            },
            "left_out": self.left_out,
            "seconds": self.seconds,
            "outcomes": self.outcomes,
            "rows": [asdict(row) for row in rows],
        }


def table(rows: Sequence[Row]) -> str:
    """Rows as text, in columns."""
    lines = [tuple(Row.__dataclass_fields__), *(tuple(asdict(row).values()) for row in rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    return "".join("  ".join(map(str.ljust, line, widths)).rstrip() + "\n" for line in lines)


def machine_text(name: str, machine: Mapping[str, Any]) -> str:
    """What a child computes with, on one line."""
    cores = ", ".join(f"{library} {core}" for library, (core, _) in machine["openblas"].items()) or "unknown"
    numpy = " ".join(machine["numpy"]) or "baseline"
    return f"{name}: OpenBLAS {cores}; libm {machine['libm']}; numba {machine['numba'][0]}; numpy {numpy}"
