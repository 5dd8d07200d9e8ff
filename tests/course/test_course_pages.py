import re
import shutil

import pytest

from flockana.base.errors import ArgumentError
from flockana.course import build, course_pages
from flockana.theorems.catalogue import catalogue

FOLDER = build.lectures()
_GREEK = (
    r"\\(?:alpha|beta|gamma|delta|epsilon|varepsilon|zeta|eta|theta|kappa|lambda|mu|nu|xi|pi|rho|sigma|tau|phi|psi|omega"
    r"|Gamma|Delta|Theta|Lambda|Xi|Pi|Sigma|Phi|Psi|Omega|ell)(?![a-zA-Z])"
)
_NO_SYMBOL = r"\\(?:text|mathrm|operatorname|mathbf|mathbb|begin|end)(?:\{[^{}]*\}|\s*\w)"
_INDEX = r"(?:\{[^{}]*\}|\\[a-zA-Z]+|[\w*])"
_DUMMY = set("efgijkpqtuvxyz")  # sums, functions and their arguments; and what has the same letter in every lecture


def letters(formula):
    """The letters of a formula that stand alone: capitals, Greek ones, and such small ones as name a quantity.

    With an index or a prime, as in ``d_1``, it is another symbol; so are ``\\Delta t``, ``\\Delta(A)`` and ``c^*``.
    """
    formula = re.sub(r"\\Delta(?: t\b|\(A\))|c\^\*|\\t?frac\{d\}\{dt\}|\\pi\b|\\mathbf 1|\bdt\b", " ", formula)
    formula = re.sub(_NO_SYMBOL, " ", formula)
    for _ in range(3):
        formula = re.sub(rf"\^\s*{_INDEX}", "", formula)
    for _ in range(3):
        formula = re.sub(rf"(?:{_GREEK}|[A-Za-z])?_{_INDEX}|[A-Za-z]'+", " ", formula)
    greek = set(re.findall(_GREEK, formula))
    plain = re.sub(r"\\[a-zA-Z]+|\w{2,}", lambda found: "" if found[0][0] == "\\" else found[0], formula)
    return greek | set(re.findall(r"[A-Za-z]", plain)) - _DUMMY


def test_statements_are_numbered_and_those_of_the_library_exist():
    for source in build.sources():
        book, entry = build.notebook(source, "student"), course_pages.entry_of(source)
        text = "\n".join(cell.source for cell in book.cells if cell.cell_type == "markdown")
        places = re.findall(r"^> \*\*(\w+\.\d+) (?:Theorem|Lemma|Proposition|Corrected)", text, re.MULTILINE)
        number = re.sub(r"^0(?=\d)", "", entry.number)
        assert places == [f"{number}.{k + 1}" for k in range(len(places))]
        marked = dict(re.findall(r"^> \*\*(\w+\.\d+) [^*]*\*\* `([\w-]+)`", text, re.MULTILINE))
        assert marked == entry.theorems
        assert set(marked.values()) <= set(catalogue())


@pytest.mark.parametrize("source", build.sources(), ids=lambda path: path.stem)
def test_a_lecture_s_core_is_short_and_its_depth_is_folded(source):
    entry = course_pages.entry_of(source)
    cells = [cell for cell in build.notebook(source, "student").cells if not build.tags(cell)]
    texts = [cell.source for cell in cells if cell.cell_type == "markdown"]
    core = "\n".join(re.sub(r"(?s)<details>.*?</details>", "", text) for text in texts[:1] + texts[2:-1])
    assert entry.number.startswith("A") or 1200 <= len(core.split()) <= 1500
    assert all(text.count("<details>") == text.count("</details>") for text in texts)
    assert not re.search(r"^\*Proof", core, re.MULTILINE)
    assert not re.search(r"<details>(?:(?!</details>).)*<details>", "".join(texts), re.DOTALL)
    sections = dict(re.findall(r"^## (.+)\n([^#]*)", core, re.MULTILINE))
    assert all(not sections[head].strip() for head in entry.depth)
    collapsed = [cell for cell in cells if "outputs_hidden" in cell.metadata.get("jupyter", {})]
    assert all(cell.cell_type == "code" and cell.metadata["jupyter"]["source_hidden"] for cell in collapsed)


def test_the_map_holds_every_lecture_after_those_that_it_builds_on():
    found = course_pages.course_map(FOLDER)
    numbers = [each.number for each in found]
    assert len(numbers) == len(set(numbers)) == len(list(FOLDER.glob("[0-9A]*_*.py")))
    assert numbers[:2] == ["00", "00a"]  # a first run, then the tools
    page = course_pages.map_page(FOLDER)
    for each in found:
        assert each.minutes >= 20
        assert f"| {each.number} | {each.title} |" in page
        assert all(f"L{before} --> L{each.number}" in page for before in each.after)
        assert not any(re.search(r"[{}\\]", text) for text in each.references)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('[01]\nafter = ["00"]', '[01]\nafter = ["13"]', "lecture 01 builds on .*13"),
        ("[13]\n", "[16]\n", "lectures.toml lists .*'16'"),
    ],
)
def test_a_map_that_does_not_fit_is_refused(tmp_path, old, new, message):
    folder = tmp_path / "lectures"
    shutil.copytree(FOLDER, folder)
    table = folder / "lectures.toml"
    assert old in table.read_text()
    table.write_text(table.read_text().replace(old, new))
    with pytest.raises(ArgumentError, match=message):
        course_pages.course_map(folder)


def test_one_table_defines_every_symbol_once():
    table = course_pages.notation(FOLDER)
    numbers = {each.number for each in course_pages.course_map(FOLDER)}
    symbols = [symbol for row in table for symbol in re.findall(r"\$([^$]+)\$", row["symbol"])]
    assert len(symbols) == len(set(symbols))
    rows = [set().union(*map(letters, re.findall(r"\$([^$=]+)", row["symbol"]))) for row in table]
    assert sum(map(len, rows)) == len(set().union(*rows))
    assert all(row["lectures"] == "all" or set(row["lectures"].split()) <= numbers for row in table)
    page = course_pages.notation_page(FOLDER)
    assert all(row["meaning"] in page for row in table)


@pytest.mark.parametrize("source", build.sources(), ids=lambda path: path.stem)
def test_a_lecture_lists_the_symbols_that_it_uses(source):
    """Of the symbols with an index that had two meanings once."""
    entry = next(each for each in course_pages.course_map(FOLDER) if each.number == course_pages.number_of(source))
    text, head = source.read_text(), course_pages.header(entry, FOLDER)
    for pattern, row in (
        (r"c_1\^\\alpha", r"| $c_1^\alpha$"),
        (r"\\hat L\b", r"| $L$, $\hat L"),
        (r"U_\\lambda", r"| $U_\lambda$"),
        (r"\\lambda_2", r"| $\lambda_2$"),
        (r"q_r\b", "| $q_r$, $p_r$"),
        (r"a_\{ij\}", "| $a_{ij}$"),
        (r"H_\\lambda", "| $H$, $H_"),
    ):
        if re.search(pattern, text):
            assert row in head, row


@pytest.mark.parametrize("source", build.sources(), ids=lambda path: path.stem)
def test_every_letter_of_a_lecture_is_in_the_table_and_lists_the_lecture(source):
    """So one row, with one meaning, stands for it in all lectures (`test_one_table_defines_every_symbol_once`)."""
    number, known = course_pages.number_of(source), set()
    for row in course_pages.notation(FOLDER):
        if row["lectures"] == "all" or number in row["lectures"].split():
            for symbol in re.findall(r"\$([^$]+)\$", row["symbol"]):
                known |= letters(symbol)
    text = "\n".join(line[2:] for line in source.read_text(encoding="utf-8").splitlines() if line.startswith("# "))
    formulas = ["".join(pair) for pair in re.findall(r"\$\$(.*?)\$\$|\$([^$]+)\$", text, re.DOTALL)]
    assert len(formulas) > 3
    assert {each: [f for f in formulas if each in letters(f)] for f in formulas for each in letters(f) - known} == {}
