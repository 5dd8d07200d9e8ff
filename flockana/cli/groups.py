"""The root help: commands in groups, each with one line and one example."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

GROUPS: dict[str, dict[str, tuple[str, str]]] = {
    "Look": {
        "scenarios": ("List published simulations.", "flockana scenarios --source jond"),
        "theorems": ("List theorems and errata.", "flockana theorems collision"),
        "animate": ("Write a film of a run.", "flockana animate maze -o maze.gif"),
        "explore": ("Drag and change a flock in the browser.", "flockana explore paper-flocking"),
    },
    "Verify": {
        "verify": ("Run, check theorems, write a report.", "flockana verify hexagon"),
        "observe": ("Judge a recorded flock.", "flockana observe tracks.csv"),
        "falsify": ("Search for a run that breaks a claim.", "flockana falsify collision-energy --on head-on"),
        "prove": ("Check the executable proofs.", "flockana prove cohesion"),
        "check": ("Check a certificate.", "flockana check basin.json"),
    },
    "Analyse": {
        "lattice": ("Measure a configuration.", "flockana lattice square:4x5"),
        "equilibrium": ("Find and classify an equilibrium.", "flockana equilibrium hexagonal-spiral:19"),
        "stability": ("Poles, modes, delay margins, norms.", "flockana stability hexagon --delay"),
        "ensemble": ("Shares over many seeds.", "flockana ensemble paper-flocking --seeds 20"),
    },
    "Save and export": {
        "run": ("Simulate and save as netCDF.", "flockana run hexagon -o hexagon.nc"),
        "export": ("Write a scenario for LAMMPS.", "flockana export lammps hexagon -o folder"),
        "course": ("Write the lectures as notebooks.", "flockana course lectures"),
    },
}


def example(command: str) -> str:
    """Return the example of a command.

    Examples
    --------
    >>> example("verify")
    'flockana verify hexagon'
    """
    return next((group[command][1] for group in GROUPS.values() if command in group), f"flockana {command} --help")


class Groups(TyperGroup):
    """The root command, whose help lists commands by what they are for."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the groups of commands."""
        listed: set[str] = set()
        for heading, group in GROUPS.items():
            known = {name: entry for name, entry in group.items() if name in self.commands}
            listed |= set(known)
            if known:
                self._write(formatter, heading, {name: f"{text}\n{line}" for name, (text, line) in known.items()})
        rest = {name: self.commands[name].get_short_help_str() for name in self.commands if name not in listed}
        if rest:
            self._write(formatter, "More", rest)

    def _write(self, formatter: Any, heading: str, rows: dict[str, str]) -> None:
        width = max(map(len, self.commands))
        with formatter.section(heading):
            for name, text in rows.items():
                first, *others = text.splitlines()
                formatter.write(f"{'':{formatter.current_indent}}{name:{width}}  {first}\n")
                for other in others:
                    formatter.write(f"{'':{formatter.current_indent + width + 2}}$ {other}\n")
