import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import UnknownNameError
from flockana.plots.animation import durations
from flockana.plots.paper_figures import COLUMNS


@pytest.fixture(scope="module")
def run():
    return fl.simulate(fl.Algorithm1(), [[0.0, 0.0], [7.5, 0.0]], np.zeros((2, 2)), (0, 30))


@pytest.mark.slow
def test_pdf_has_no_type_3_fonts(run, tmp_path):
    path = fl.plots.save(fl.plots.panel(run)[0], tmp_path / "panel.pdf", column="ieee-wide")
    data = path.read_bytes()
    assert b"/Type3" not in data
    assert b"/CIDFontType2" in data


def test_a_column_sets_the_width(run):
    figure, axes = fl.plots.subplots(2, 2, size="elsevier")
    assert figure.get_size_inches().tolist() == [COLUMNS["elsevier"], 2.655]
    fl.plots.panel(run, ax=axes)
    labels = [each.get_ylabel() for each in axes.ravel()]
    assert labels[3].endswith("time$^2$)") or "time" in labels[3]
    assert not any(label.count("\n") > 1 for label in labels)
    with pytest.raises(UnknownNameError, match="unknown column 'iee'; did you mean 'ieee'"):
        fl.plots.subplots(size="iee")


def test_values_that_span_decades_are_logarithmic_above_a_shaded_floor(run):
    axes = fl.plots.panel(run)
    assert [each.get_yscale() for each in axes] == ["linear", "linear", "log", "log"]
    assert "noise floor" in axes[3].get_legend_handles_labels()[1]
    assert max(patch.get_y() + patch.get_height() for patch in axes[3].patches) == pytest.approx(
        0.5 * run.floors.speed**2
    )


@pytest.mark.parametrize(("fps", "seconds"), [(15.0, 10.0), (24.0, 3.0), (7.0, 2.0)])
def test_times_of_frames_add_up(fps, seconds):
    times = durations(round(fps * seconds), fps)
    assert sum(times) == 1000 * seconds
    assert max(times) - min(times) in (0, 10)
