"""One picture of each scenario that a theorem page shows: the flock at the start, in the middle and at the end."""

from __future__ import annotations

import base64

from flockana.report.figures import pictures
from flockana.scenarios import scenario, scenarios
from tools.site.cache import kept

_CODE = tuple(f"flockana/{room}" for room in ("symbolic", "kernels", "interactions", "laws", "dynamics", "plots"))
_MOST = 60_000.0  # agents × time: what costs more than that shows nothing new


def shown(theorem: str) -> str | None:
    """The scenario that a theorem page shows: the largest that it is checked on and that is cheap; None if none is."""
    fitting = [(cost, name) for name in checked_on(theorem) if (cost := _cost(name)) <= _MOST]
    return max(fitting)[1] if fitting else None


def checked_on(theorem: str) -> tuple[str, ...]:
    """Scenarios of the catalogue that a theorem is checked on."""
    return tuple(name for name in scenarios() if theorem in scenario(name).theorems)


def _cost(name: str) -> float:
    case = scenario(name)
    return case.shape[0] ** 2 * float(case.t_span[1] - case.t_span[0])


def picture(name: str) -> tuple[str, bytes]:
    """Caption and PNG of a scenario's flock."""
    caption, image = kept("pictures", name, _CODE, lambda: _drawn(name))
    return caption, base64.b64decode(image)


def _drawn(name: str) -> tuple[str, str]:
    first = pictures(scenario(name).run())[0]
    return first.caption, first.source.partition(",")[2]
