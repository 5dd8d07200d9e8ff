"""α-lattices: build them, measure any configuration, find crossings, test planarity and rigidity."""

from flockana.lattice.builders import (
    bcc,
    fcc,
    hcp,
    hexagonal_patch,
    hexagonal_spiral,
    honeycomb,
    line,
    max_ratio,
    simple_cubic,
    square,
    triangular,
)
from flockana.lattice.crossings import Separation, crossings, separation
from flockana.lattice.defects import Defects, coordination, defects
from flockana.lattice.measure import classify, edge_length_error, is_alpha_lattice, links, strain
from flockana.lattice.planarity import (
    Kuratowski,
    harborth,
    is_complete,
    is_planar,
    kuratowski,
    planar_bound,
)
from flockana.lattice.rigidity import Rigidity, rigidity, rigidity_matrix

__all__ = [
    "Defects",
    "Kuratowski",
    "Rigidity",
    "Separation",
    "bcc",
    "classify",
    "coordination",
    "crossings",
    "defects",
    "edge_length_error",
    "fcc",
    "harborth",
    "hcp",
    "hexagonal_patch",
    "hexagonal_spiral",
    "honeycomb",
    "is_alpha_lattice",
    "is_complete",
    "is_planar",
    "kuratowski",
    "line",
    "links",
    "max_ratio",
    "planar_bound",
    "rigidity",
    "rigidity_matrix",
    "separation",
    "simple_cubic",
    "square",
    "strain",
    "triangular",
]
