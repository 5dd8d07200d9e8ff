import re

import pytest

from flockana.course import build
from flockana.course.slides import slides

LECTURES = [path for path in build.sources() if not path.name.startswith("A")]


@pytest.mark.parametrize("source", LECTURES, ids=lambda path: path.stem)
def test_a_slide_for_each_heading_and_all_that_is_shown(source):
    text = source.read_text(encoding="utf-8").partition("# ## Exercises")[0]
    book = slides(source)
    kinds = [cell.metadata["slideshow"]["slide_type"] for cell in book.cells]
    heads = [cell.source.splitlines()[0] for cell in book.cells if cell.cell_type == "markdown"]
    expected = re.findall(r"(?m)^# (##? .+)$", text)
    assert [head for head in heads if head in expected] == expected
    assert kinds[0] == "slide"
    for kind, before, cell in zip(kinds[1:], book.cells, book.cells[1:], strict=False):
        if cell.cell_type == "code":  # beside more than a line or two of text a figure does not fit
            short = before.cell_type == "markdown" and not before.source.startswith("#") and len(before.source) <= 240
            assert kind == ("-" if short else "subslide")
    assert book.cells[0].source.rstrip().endswith("</style>")
    assert kinds.count("skip") == 1
    assert len(expected) + 2 == kinds.count("slide")  # references and further reading
    shown = [cell.source for cell in build.notebook(source, "student").cells if not build.tags(cell)]
    code = [cell.source for cell in book.cells if cell.cell_type == "code"]
    assert code == [each for each in shown if each in code]
    assert len(code) >= 2
    assert not any("answered(" in each for each in code)
    assert not any(" = ..." in each for each in code)
