"""`flockana export`: hand a scenario to another program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from flockana.cli.command_output import OK, show, show_files, show_json
from flockana.cli.shared_options import AsJson, CaseName, Seed, output


def export_command(
    to: Annotated[Literal["lammps"], typer.Argument(metavar="PROGRAM", help="Target program.")],
    name: CaseName,
    *,
    folder: Annotated[Path, output("Folder to write to.", metavar="DIR")],
    seed: Seed = 0,
    points: Annotated[int, typer.Option(min=2, help="Number of distances in the pair force's table.")] = 20_000,
    inner: Annotated[float | None, typer.Option(help="First distance of the table.")] = None,
    dt: Annotated[float | None, typer.Option(help="Longest step; by default a fiftieth of the law's time.")] = None,
    samples: Annotated[int, typer.Option(min=1, help="Number of snapshots.")] = 200,
    consensus: Annotated[
        Literal["missing", "nearest"], typer.Option(help="Consensus without a pair style: leave out, or use nearest.")
    ] = "missing",
    as_json: AsJson = False,
) -> int:
    """Write law, start and run of a scenario for LAMMPS: input script, data file, tabulated pair style, README.txt.

    An earlier export in the folder is replaced. If another file there has one of these names, nothing is written.
    """
    from flockana.cli.command_subject import read_flock
    from flockana.lammps.export import export_lammps

    item = read_flock(name, seed)
    options: dict[str, Any] = {"points": points, "inner": inner, "dt": dt, "samples": samples, "consensus": consensus}
    exported = export_lammps(item.law, item.q0, item.p0, item.t_span, folder, **options)
    if as_json:
        summary = {"steps": exported.steps, "dt": exported.dt, "force error": exported.force_error}
        words = {name: list(getattr(exported, name)) for name in ("exact", "near", "missing")}
        show_json({"scenario": name, **summary, **words, "files": [str(path) for path in exported.files]})
        return OK
    console = show(f"{item.name} for LAMMPS: {exported.steps} steps of {exported.dt:.6g}")
    lines = [f"exact: {text}" for text in exported.exact] + [f"nearly: {text}" for text in exported.near]
    lines += [f"missing: {text}" for text in exported.missing]
    lines.append(f"table: force off by at most {exported.force_error:.3g}, energy by {exported.energy_error:.3g}")
    console.print("\n".join(lines), markup=False)
    show_files(**{path.name: path for path in exported.files})
    return OK
