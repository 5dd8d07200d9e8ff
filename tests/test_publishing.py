"""What a package index, a recipe and a reader off the repository need."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def readme_on_the_index() -> str:
    """The README as the build writes it into the metadata."""
    text = (ROOT / "README.md").read_text()
    for each in PROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]:
        text = re.sub(each["pattern"], each["replacement"], text)
    return text


def test_links_and_pictures_of_the_readme_lead_to_the_repository_when_read_elsewhere():
    text, home = readme_on_the_index(), PROJECT["project"]["urls"]["Repository"]
    targets = re.findall(r"(!?)\[[^\]]*\]\(([^)]+)\)", text)
    assert len(targets) >= 10
    raw = home.replace("github.com", "raw.githubusercontent.com") + "/main/"
    for picture, target in targets:
        start = raw if picture else f"{home}/blob/main/"
        assert target.startswith((start, "https://")), target
        if target.startswith(start):
            assert (ROOT / target.removeprefix(start)).exists(), target


def test_the_address_of_the_repository_is_one():
    home = PROJECT["project"]["urls"]["Repository"]
    assert all(url.startswith(home) for url in PROJECT["project"]["urls"].values())
    for name in ("CITATION.cff", "conda/meta.yaml"):
        named = re.findall(r"https://github\.com/\S+?(?=[\"\s/]|$)(?:/[\w-]+)?", (ROOT / name).read_text())
        assert named, name
        assert all(each.startswith(home) for each in named), name


def test_the_recipe_of_conda_asks_for_what_the_package_asks_for():
    text = (ROOT / "conda/meta.yaml").read_text()
    run = re.search(r"  run:\n((?:    - .*\n)+)", text)
    assert run is not None
    wanted = [re.sub(r"^matplotlib(?=[><])", "matplotlib-base", each) for each in PROJECT["project"]["dependencies"]]
    assert [line.strip("- ").replace(" ", "") for line in run[1].splitlines()] == ["python>=3.11", *wanted]
    version = re.search(r'__version__ = "([\d.]+)', (ROOT / "flockana/_version.py").read_text())
    assert version is not None
    assert f'version = "{version[1]}"' in text


def test_the_paper_cites_what_its_list_holds():
    text, listed = (ROOT / "paper/paper.md").read_text(), (ROOT / "paper/paper.bib").read_text()
    cited = set(re.findall(r"(?<![\w.])-?@(\w+)", text))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", listed, re.MULTILINE))
    assert 700 <= len(text.split()) <= 1100
