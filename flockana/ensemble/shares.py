"""Shares of the runs of an ensemble in which each claim holds, with confidence intervals."""

from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING

from flockana.base.binomial_intervals import clopper_pearson, ensure_level
from flockana.base.errors import ArgumentError
from flockana.ensemble.one_run import COMPLETE, DIED, ERROR, FAILED

if TYPE_CHECKING:
    import xarray

STATUSES = ("verified", "refuted", "vacuous", "inconclusive")
RUNS = (COMPLETE, FAILED, ERROR, DIED)


def shares(dataset: "xarray.Dataset", *, level: float = 0.95) -> "xarray.Dataset":
    """Return the shares of runs in which each claim is verified and refuted, with Clopper-Pearson intervals.

    The share is of all complete runs on which the claim was checked, those on which it is vacuous or inconclusive
    included: what is not verified is not counted as if it were.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `ensemble`.
    level : float
        Confidence of each interval by itself.

    Returns
    -------
    xarray.Dataset
        Over parameters and claims: ``runs`` (how many checked the claim), a count for each status, and ``share``,
        ``low`` and ``high`` over a dimension ``of`` with the entries verified and refuted. Over parameters alone:
        ``incomplete``, the number of runs that are left out because they did not complete.

    Raises
    ------
    ArgumentError
        If the dataset is none of an ensemble, or the level no confidence.

    Examples
    --------
    >>> from flockana.ensemble import ensemble
    >>> table = shares(ensemble("hexagon", range(3), theorems=["energy"], jobs=1))
    >>> part = table.sel(claim="energy:balance", of="verified")
    >>> int(part.runs), float(part.share), round(float(part.low), 3)
    (3, 1.0, 0.292)
    """
    import xarray

    if not (isinstance(dataset, xarray.Dataset) and {"status", "run"} <= {*dataset} and "seed" in dataset.dims):
        raise ArgumentError(f"dataset is {type(dataset).__name__}: expected what flockana.ensemble returned")
    ensure_level(level)
    counts = {name: (dataset.status == code).sum("seed") for code, name in enumerate(STATUSES)}
    runs = (dataset.status >= 0).sum("seed")
    judged_counts = xarray.concat([counts["verified"], counts["refuted"]], dim="of")
    trials = runs.broadcast_like(judged_counts)
    low, high = clopper_pearson(judged_counts.values, trials.values, level=level)
    share = (judged_counts / trials.where(trials > 0)).assign_attrs(long_name="share of the runs")
    incomplete = (dataset.run != RUNS.index(COMPLETE)).sum("seed")
    table = {"share": share, "low": judged_counts.copy(data=low), "high": judged_counts.copy(data=high), "runs": runs}
    table |= {"incomplete": incomplete, **counts}
    return xarray.Dataset(table, attrs=dataset.attrs | {"level": level}).assign_coords(of=["verified", "refuted"])


def share_cells(table: "xarray.Dataset") -> Iterator[tuple[str, str, str, str, str, str, str]]:
    """Yield a table row per claim: parameters, claim, runs, % verified, % refuted, vacuous, inconclusive."""
    # Shares are in per cent, with their intervals; the last two are numbers of runs.
    axes = [str(name) for name in table.runs.dims if name != "claim"]
    for values in product(*(table[name].values.tolist() for name in axes)):
        point = dict(zip(axes, values, strict=True))
        for label in table.claim.values.tolist():
            counts = table.sel(point | {"claim": label})
            if int(counts.runs):
                vacuous, inconclusive = (str(int(counts[of]) or "") for of in ("vacuous", "inconclusive"))
                verified, refuted = (_interval(counts.sel(of=of)) for of in ("verified", "refuted"))
                point_text = ", ".join(f"{name} = {value}" for name, value in point.items())
                yield point_text, label, str(int(counts.runs)), verified, refuted, vacuous, inconclusive


def _interval(entry: "xarray.Dataset") -> str:
    share, low, high = (100.0 * float(entry[name]) for name in ("share", "low", "high"))
    return f"{share:.1f} [{low:.1f}, {high:.1f}]"
