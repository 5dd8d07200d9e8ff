"""Root help of the command line: grouped commands, each with one line and one example."""

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
        "observe": ("Judge a recorded flock.", "flockana observe example --sd 0.05"),
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
EXAMPLES = {name: example for group in GROUPS.values() for name, (_, example) in group.items()}


class Groups(TyperGroup):
    """Root command with a help page that groups commands by purpose."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the groups of commands, each command with its example below."""
        width = max(map(len, EXAMPLES))
        for heading, group in GROUPS.items():
            with formatter.section(heading):
                for name, (text, example) in group.items():
                    formatter.write(f"{'':{formatter.current_indent}}{name:{width}}  {text}\n")
                    formatter.write(f"{'':{formatter.current_indent + width + 2}}$ {example}\n")
