"""Collapse under the pull of the γ-agent."""

import pytest

from flockana.base.errors import ArgumentError, SolverError
from flockana.equilibria.lattice_collapse import CollapseDiagram, collapse_diagram, collapse_threshold, threshold
from flockana.interactions import AlphaInteraction


@pytest.mark.slow
def test_collapse_by_equilibria():
    diagram = collapse_diagram(AlphaInteraction(), [7, 19], [0.1, 2.0, 4.5])
    assert isinstance(diagram, CollapseDiagram)
    assert diagram.closest[0, 0] == pytest.approx(0.99, abs=0.02)
    assert diagram.onset().tolist() == [4.5, 2.0]
    assert diagram.closest[1, 1] == 0.0
    assert (diagram.coincident[:, 0] == 0).all()
    low, high = collapse_threshold(AlphaInteraction(), 7, halvings=2)
    assert (
        3.0 < low < high < 5.0
    )  # as the gradient flow has it: tests/sources/geschwender_2016/theorems/test_e11_lattice_under_target.py
    with pytest.raises(ArgumentError, match="expected rising"):
        collapse_diagram(AlphaInteraction(), [7], [1.0, 0.5])
    with pytest.raises(SolverError, match="no collapse"):
        threshold(lambda ratio: False)
