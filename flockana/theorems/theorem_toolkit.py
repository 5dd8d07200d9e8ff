"""Common names for theorem files: runs and enclosures, hypotheses, claims."""
# ruff: noqa: F401
# mypy: implicit-reexport

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.claims import (
    by_count,
    counted,
    equal,
    erratum,
    exact,
    judged,
    of_map,
    of_state,
    run_theorem,
    spectral,
    undecided,
    vacuous,
)
from flockana.theorems.enclosure import Enclosure, stacked
from flockana.theorems.hypotheses import condition, law_is, positive, positive_room
from flockana.theorems.limit_certificates import Certificate, evidence, limit_claim
from flockana.theorems.observed_run import Observed, observed
from flockana.theorems.random_start_shares import always, mostly
from flockana.theorems.rounding_bounds import EPS
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances, unmet
