"""Records of an ensemble as an `xarray.Dataset`."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana._version import __version__
from flockana.ensemble.one_run import Job, Record, Request, Scalar
from flockana.ensemble.shares import RUNS, STATUSES
from flockana.measures.measure import measures

if TYPE_CHECKING:
    import xarray

RESERVED = (
    *("seed", "claim", "theorem", "status", "margin", "error", "verdict"),
    *("run", "message", "steps", "evaluations", "seconds"),
)


@dataclass(frozen=True)
class Grid:
    """Runs of an ensemble in dataset order: varied parameters, fixed parameters, seeds fastest."""

    axes: Mapping[str, Sequence[Scalar]]
    fixed: Mapping[str, Scalar]
    seeds: tuple[int, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each parameter, and of seeds."""
        return (*map(len, self.axes.values()), len(self.seeds))

    def jobs(self, most: int | None = None) -> list[Job]:
        """Return all runs, or the runs of the first seeds."""
        points = (dict(zip(self.axes, values, strict=True)) for values in product(*self.axes.values()))
        options = (tuple(sorted({**point, **self.fixed}.items())) for point in points)
        return [Job(seed, option) for option in options for seed in self.seeds[:most]]


def to_dataset(request: Request, grid: Grid, records: Sequence[Record]) -> "xarray.Dataset":
    """Return records as a dataset along parameters, seeds, claims and theorems."""
    import xarray

    from flockana.ensemble.share_tables import Runs  # loads xarray

    dims = (*grid.axes, "seed")
    claims = list(dict.fromkeys(name for record in records for name in record.claims))
    theorems = list(dict.fromkeys(name for record in records for name in record.verdicts))

    def over_runs(values: Sequence[Any], dtype: Any, **attributes: Any) -> xarray.Variable:
        return xarray.Variable(dims, np.array(values, dtype=dtype).reshape(grid.shape), attributes)

    def by(name: str, labels: Sequence[str], rows: Sequence[Sequence[Any]], **attributes: Any) -> xarray.Variable:
        dtype = np.int8 if "flag_values" in attributes else np.float64
        table = np.array(rows, dtype=dtype).reshape(*grid.shape, len(labels))
        return xarray.Variable((*dims, name), table, attributes)

    claimed = [[record.claims.get(name, (None, None, None)) for name in claims] for record in records]
    verdicts = [[_code(STATUSES, record.verdicts.get(name)) for name in theorems] for record in records]
    codes = [[_code(STATUSES, status) for status, _, _ in row] for row in claimed]
    margins, errors = ([[entry[k] for entry in row] for row in claimed] for k in (1, 2))
    variables = {
        "status": by("claim", claims, codes, **_flags(STATUSES)),
        "margin": by("claim", claims, margins, long_name="margin of a claim"),
        "error": by("claim", claims, errors, long_name="error of a margin"),
        "verdict": by("theorem", theorems, verdicts, **_flags(STATUSES)),
        "run": over_runs([_code(RUNS, record.status) for record in records], np.int8, **_flags(RUNS)),
        "message": over_runs([record.message for record in records], object, long_name="why a run did not complete"),
        "steps": over_runs([record.stats.get("steps", 0) for record in records], np.int64),
        "evaluations": over_runs([record.stats.get("evaluations", 0) for record in records], np.int64),
        "seconds": over_runs([record.seconds for record in records], np.float64, long_name="wall time", units="s"),
    }
    for name in request.metrics:
        values = [record.metrics.get(name, np.nan) for record in records]
        it = None if ":" in name else measures()[name]
        described = {"long_name": metric_name(name)} if it is None else {"long_name": it.summary, "units": it.unit}
        variables[metric_name(name)] = over_runs(values, np.float64, **described)
    coords: dict[str, Any] = {name: list(values) for name, values in grid.axes.items()} | dict(grid.fixed)
    coords["seed"] = list(grid.seeds)
    coords |= {"claim": np.array(claims, dtype=object), "theorem": np.array(theorems, dtype=object)}
    attributes = {
        "scenario": request.scenario,
        "tolerances": json.dumps(request.to_dict()["tolerances"]),
        "mathematics": request.mathematics,
        "flockana_version": __version__,
    }
    return Runs(variables, coords, attributes)


def metric_name(name: str) -> str:
    """Return the variable name of a measure, or of the function in ``"module:function"``."""
    return name.rpartition(":")[2]


def _flags(names: Sequence[str]) -> dict[str, Any]:
    """Return the meanings of status codes in the CF convention; -1 stands for a missing claim or run."""
    return {"flag_values": list(range(len(names))), "flag_meanings": " ".join(names)}


def _code(names: Sequence[str], name: str | None) -> int:
    return -1 if name is None else names.index(name)
