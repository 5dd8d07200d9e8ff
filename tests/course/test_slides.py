import re

import pytest

from flockana.course import build
from flockana.course.slides import slides

LECTURES = [path for path in build.sources() if not path.name.startswith("A")]


@pytest.mark.slow
@pytest.mark.parametrize("source", LECTURES, ids=lambda path: path.stem)
def test_a_slide_for_each_figure_with_one_sentence_and_all_code(source):
    text = source.read_text(encoding="utf-8").partition("# ## Exercises")[0]
    cells = slides(source).cells
    kinds = [cell.metadata["slideshow"]["slide_type"] for cell in cells]
    figures = re.findall(r"(?m)^# \*\*Figure \w+\.\d+\.\*\* (\S+ \S+)", text)
    texts = [cell.source.partition("<style>")[0] for cell in cells if cell.cell_type == "markdown"]
    assert len(texts) == kinds.count("slide") == len(figures) + 1
    assert texts[0].startswith(re.search(r"(?m)^# (# .+)$", text)[1])
    for said, first in zip(texts[1:], figures, strict=True):
        head, _, sentence = said.partition("\n\n")
        assert f"\n# {head}\n" in text
        assert sentence.startswith(first)
    assert all(len(said.split()) <= 60 for said in texts)
    assert all(re.search(r"[.?]\s*\Z", said) for said in texts)
    shown = {k + 1 for k, cell in enumerate(cells) if cell.cell_type == "markdown" and k > 0}
    assert {k for k, kind in enumerate(kinds) if kind == "-"} == shown
    code = [cell.source for cell in build.notebook(source, "student").cells if cell.cell_type == "code"]
    kept = [cell.source for cell in cells if cell.cell_type == "code"]
    assert kept == [each for each in code if each in kept]
    assert not any("answered(" in each or " = ..." in each for each in kept)
