"""What a package index, a recipe and a reader off the repository need."""

import re
import tomllib
from pathlib import Path

import jinja2
import yaml

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
README = (ROOT / "README.md").read_text()


def readme_on_the_index() -> str:
    """The README as the build writes it into the metadata."""
    text = README
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
    """The recipe as conda-build reads it: rendered by jinja, then YAML."""
    text = (ROOT / "conda/meta.yaml").read_text()
    recipe = yaml.safe_load(jinja2.Template(text, undefined=jinja2.StrictUndefined).render(PYTHON="python"))
    project, python = PROJECT["project"], "python" + PROJECT["project"]["requires-python"]
    wanted = [re.sub(r"^matplotlib(?=[><])", "matplotlib-base", each) for each in project["dependencies"]]
    needs = {part: [each.replace(" ", "") for each in listed] for part, listed in recipe["requirements"].items()}
    assert needs == {"host": [python, "pip", *PROJECT["build-system"]["requires"]], "run": [python, *wanted]}
    assert recipe["build"]["entry_points"] == [f"{name} = {where}" for name, where in project["scripts"].items()]
    version = re.search(r'__version__ = "([\d.]+)', (ROOT / "flockana/_version.py").read_text())
    assert version is not None
    assert recipe["package"] == {"name": project["name"], "version": version[1]}
    about = recipe["about"]
    assert (about["summary"], about["license"]) == (project["description"], project["license"])
    assert [about["license_file"]] == project["license-files"]


def test_binder_installs_the_checkout_and_opens_a_notebook_that_it_writes():
    """What repo2docker does with .binder: pip install -r, postBuild, a server at the address of the badge."""
    (wanted,) = (ROOT / ".binder/requirements.txt").read_text().split()
    extra = re.fullmatch(r"\.\[(\w+)\]", wanted)
    assert extra is not None
    names = {re.split(r"[\[<>=]", each)[0] for each in PROJECT["project"]["optional-dependencies"][extra[1]]}
    assert {"jupyterlab", "ipykernel", "jupytext"} <= names
    python = (ROOT / ".binder/runtime.txt").read_text().strip().removeprefix("python-")
    assert f"Programming Language :: Python :: {python}" in PROJECT["project"]["classifiers"]
    commands = (ROOT / ".binder/postBuild").read_text()
    home = PROJECT["project"]["urls"]["Repository"].removeprefix("https://github.com/")
    address = re.search(r"https://mybinder\.org/v2/gh/(\S+)/main\?urlpath=lab/tree/(\w+)/(\w+)\.ipynb", README)
    assert address is not None
    assert address[1] == home
    assert f"flockana course {address[2]}\n" in commands
    assert (ROOT / f"notebooks/{address[3]}.py").exists()


def test_workflows_are_read_and_prepare_for_macos_and_windows():
    jobs = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text())["jobs"]
    assert jobs["whole"]["strategy"]["matrix"]["os"] == ["ubuntu-latest", "macos-latest"]
    assert jobs["windows"]["runs-on"] == "windows-latest"
    (installed,) = [step["run"] for step in jobs["windows"]["steps"] if "pip install" in step.get("run", "")]
    assert re.search(r"\[(\w+)\]", installed)[1] in PROJECT["project"]["optional-dependencies"]


def test_the_paper_cites_what_its_list_holds():
    text, listed = (ROOT / "paper/paper.md").read_text(), (ROOT / "paper/paper.bib").read_text()
    cited = set(re.findall(r"(?<![\w.])-?@(\w+)", text))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", listed, re.MULTILINE))
    assert 700 <= len(text.split()) <= 1000
    assert re.findall(r"^# (.+)", text, re.MULTILINE) == [
        "Summary",
        "Statement of need",
        "State of the field",
        "Software design",
        "Research impact statement",
        "AI usage disclosure",
        "Acknowledgements",
        "References",
    ]
