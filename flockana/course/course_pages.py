"""Headers, references and map of the course, generated from two tables."""

import csv
import re
import tomllib
import unicodedata
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from flockana.base.bibtex_entries import cite
from flockana.base.errors import ArgumentError

_STATEMENT = re.compile(r"^> \*\*((?:Theorem|Lemma|Proposition|Corrected)[^*]*)\*\*", re.MULTILINE)
_PROOF = re.compile(r"^\*(Proof[^*]*?)[.:]?\*.*?\\square[^\n]*(?:\n\\end[^\n]*)?$", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r"(\w+)\s*=\s*\{((?:[^{}]|\{[^{}]*\})*)\}")

_ACCENTS = {'"': "\u0308", "'": "\u0301"}


@dataclass(frozen=True)
class Lecture:
    """Entry of a lecture in the course map, or of an assignment, whose number begins with A."""

    number: str  # number, title: as in its file's name and its first line
    title: str
    after: tuple[str, ...]  # numbers of the lectures that it builds on
    minutes: int  # for reading and running it, exercises apart
    references: tuple[str, ...]  # references, further: what it rests on, and what to read next, as text
    further: tuple[str, ...]
    depth: tuple[str, ...]  # headings of sections that are folded: no part of the core of 45 minutes
    theorems: Mapping[str, str]  # those of its statements, by number, that the library has


def number_of(source: Path) -> str:
    """Return the number of a lecture from its file name."""
    return source.stem.partition("_")[0]


def course_map(folder: Path) -> list[Lecture]:
    """Return the lectures in teaching order."""
    table = tomllib.loads((folder / "lectures.toml").read_text(encoding="utf-8"))
    files = {number_of(path): path for path in sorted(folder.glob("[0-9A][0-9]*_*.py"))}
    if set(table) != set(files):
        raise ArgumentError(f"lectures.toml lists {sorted(table)}; the folder holds {sorted(files)}")
    lectures: list[Lecture] = []
    for number, entry in table.items():
        early = [item for item in entry["after"] if item not in {lecture.number for lecture in lectures}]
        if early:
            raise ArgumentError(f"lecture {number} builds on {early}: expected earlier entries of lectures.toml")
        references = tuple(as_text(cite(key)) for key in entry["references"])
        title = re.search(r"^# # (.+)$", files[number].read_text(encoding="utf-8"), re.MULTILINE)
        if title is None:
            raise ArgumentError(f"{files[number].name} has no title: expected a line '# # ...'")
        after, further_texts = tuple(entry["after"]), tuple(entry["further"])
        depth, theorems = tuple(entry.get("depth", ())), entry.get("theorems", {})
        lectures.append(Lecture(number, title[1], after, entry["minutes"], references, further_texts, depth, theorems))
    return lectures


def entry_of(source: Path) -> Lecture:
    """Return a lecture's entry in the map of the course."""
    return next(item for item in course_map(source.parent) if item.number == number_of(source))


def as_text(bibtex: str) -> str:
    """Return a BibTeX entry as a line of text.

    Examples
    --------
    >>> as_text(cite("olfati-saber-2006"))
    'Olfati-Saber, R., Flocking for Multi-Agent Dynamic Systems: Algorithms and Theory, IEEE Transactions on Automatic
     Control 51(3), 401-420, 2006, doi:10.1109/TAC.2005.864190.'
    """
    field = {name: _plain(text) for name, text in _FIELD.findall(bibtex)}
    *first_authors, last_author = [_initials(name) for name in field.get("author", "").split(" and ")]
    authors = f"{', '.join(first_authors)} and {last_author}" if first_authors else last_author
    number = f"({field['number']})" if "number" in field else ""
    volume = f" {field['volume']}{number}" if "volume" in field else ""
    publication = field.get("journal") or field.get("booktitle") or field.get("howpublished") or field.get("school", "")
    doi = f"doi:{field['doi']}" if "doi" in field else f"arXiv:{field['eprint']}" if "eprint" in field else ""
    parts = (authors, field.get("title", ""), publication + volume, field.get("pages", ""), field.get("year", ""), doi)
    return ", ".join(piece_text for piece_text in parts if piece_text) + "."


def _plain(text: str) -> str:
    """Convert TeX accents to letters and drop braces."""
    accented_text = re.sub(r"\\([\"'])(\w)", lambda m: unicodedata.normalize("NFC", m[2] + _ACCENTS[m[1]]), text)
    return re.sub(r"[{}~]", "", accented_text).replace("--", "-")


def _initials(name: str) -> str:
    last_name, comma, first_name = name.partition(", ")
    return f"{last_name}, {' '.join(f'{item[0]}.' for item in first_name.split())}" if comma else name


def notation(folder: Path) -> list[dict[str, str]]:
    """Return the table of symbols: ``symbol``, ``meaning``, ``unit`` and ``lectures``."""
    with (folder / "notation.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file, delimiter="|", quoting=csv.QUOTE_NONE))


def _rows(table: list[dict[str, str]], number: str) -> Iterator[str]:
    yield "| symbol | meaning | unit |\n|---|---|---|"
    for row in table:
        if number == "all" or row["lectures"] == "all" or number in row["lectures"].split():
            yield f"| {row['symbol']} | {row['meaning']} | {row['unit']} |"


def number_statements(cells: list[Any], lecture: Lecture, mark: Callable[[str], str] = "`{}`".format) -> None:
    """Number theorems, lemmas and propositions in a lecture's cells, and mark those in the library's catalogue."""
    counter = count(1)

    def numbered(found: re.Match[str]) -> str:
        statement_number = f"{re.sub(r'^0(?=.)', '', lecture.number)}.{next(counter)}"
        name = lecture.theorems.get(statement_number)
        return f"> **{statement_number} {found[1]}**" + (f" {mark(name)}" if name else "")

    for cell in cells:
        if cell.cell_type == "markdown":
            cell.source = _STATEMENT.sub(numbered, cell.source)


def fold_depth(cells: list[Any], lecture: Lecture) -> None:
    """Fold proofs, questions and depth sections: click to open; code is collapsed with its output."""
    folded, head = {"Questions that come up", *lecture.depth}, ""
    for cell in (item for item in cells if not item.metadata.get("tags")):
        if cell.cell_type != "markdown":
            if head in folded:
                cell.metadata["jupyter"] = {"source_hidden": True, "outputs_hidden": True}
            continue
        parts = re.split(r"^## (.+)$\n?", cell.source, flags=re.MULTILINE)  # text, heading, text, heading, text ...
        for k in range(0, len(parts), 2):
            head = parts[k - 1] if k else head
            if head in folded and parts[k].strip():
                parts[k] = fold("More", parts[k])
            elif head not in folded:
                parts[k] = _PROOF.sub(lambda proof: fold(proof[1], proof[0]).strip(), parts[k])
        cell.source = "".join(f"## {part}\n" if k % 2 else part for k, part in enumerate(parts)).strip()


def fold(title: str, text: str) -> str:
    """Return text that is folded under its title until clicked."""
    return f"\n<details><summary>{title}</summary>\n\n{text.strip()}\n\n</details>\n\n"


def header(lecture: Lecture, folder: Path) -> str:
    """Return the header of a lecture: prerequisites, duration, symbols."""
    before = ", ".join(lecture.after) or "none"
    core = ", of which 45 for what is not folded" if lecture.depth else ""
    symbols = "\n".join(_rows(notation(folder), lecture.number))
    return (
        f"**Lectures before this one:** {before}. **Time:** {lecture.minutes} minutes{core}, exercises apart.\n\n"
        f"<details><summary>Symbols</summary>\n\n{symbols}\n\n</details>"
    )


def references(lecture: Lecture) -> str:
    """Return the references of a lecture."""
    lists = (("References", lecture.references), ("Further reading", lecture.further))
    return "\n\n".join(f"## {title}\n\n" + "\n".join(f"- {text}" for text in texts) for title, texts in lists)


def notation_page(folder: Path) -> str:
    """Return all symbols of the course as a page in Markdown."""
    rows = "\n".join(_rows(notation(folder), "all"))
    meaning = "Most symbols mean the same in all lectures; where one means something else, its row says in which."
    return f"# Notation\n\n{meaning}\n\n{rows}\n"


def map_page(folder: Path) -> str:
    """Return the course map in Markdown: lectures, their prerequisites, and a Mermaid drawing."""
    lectures = course_map(folder)
    rows = "\n".join(f"| {e.number} | {e.title} | {', '.join(e.after) or '–'} | {e.minutes} |" for e in lectures)
    arrows = "\n".join(f"    L{prerequisite} --> L{each.number}" for each in lectures for prerequisite in each.after)
    names = "\n".join(f'    L{each.number}["{each.number} {each.title}"]' for each in lectures)
    total = sum(each.minutes for each in lectures)
    return (
        "# Map of the course\n\n"
        "| lecture | title | after | minutes |\n|---|---|---|---|\n"
        f"{rows}\n\n{len(lectures)} lectures, {total} minutes, exercises apart.\n\n"
        f"```mermaid\ngraph TD\n{names}\n{arrows}\n```\n"
    )
