"""The lint of imports: rooms point down, only sources know sources, and of each other by public names alone."""

import pytest

from tools import import_lint

STUB = "from .laws import Law as Law\n"
FILES = {
    "sources/one/__init__.py": "",
    "sources/one/__init__.pyi": STUB,
    "sources/one/laws.py": "from flockana.laws.law import Law\n",
    "sources/one/theorems/printed.py": "from flockana.sources.one.laws import Law\nimport flockana.theorems\n",
    "sources/two/scenarios.py": "from flockana.sources.one import Law\nfrom flockana.theorems import verify\n",
}
FAULTS = {
    "a room imports a source": ("theorems/x.py", "from flockana.sources.one import Law", "only sources know sources"),
    "a part that is not public": ("sources/two/laws.py", "from flockana.sources.one.laws import Law", "a public name"),
    "a name that is not public": ("sources/two/laws.py", "from flockana.sources.one import laws", "a public name"),
    "a later kind": ("sources/one/laws.py", "import flockana.sources.one.theorems.printed", "does not come before it"),
    "a later room": ("sources/one/laws.py", "from flockana.theorems import verify", "does not come before it"),
    "an unknown kind": ("sources/one/stuff.py", "import flockana", "stuff has no stage"),
    "a room that is later": ("laws/x.py", "import flockana.theorems.x", "laws imports flockana.theorems.x"),
    "a circle": ("sources/one/scenarios.py", "from flockana.sources.two import X", "use each other in a circle"),
}


def lint(tmp_path, files):
    for name, text in files.items():
        path = tmp_path / "flockana" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return import_lint.main(tmp_path)


def test_what_points_down_passes(tmp_path, capsys):
    assert lint(tmp_path, FILES) == 0
    assert capsys.readouterr().out == "imports point down\n"


@pytest.mark.parametrize("fault", FAULTS)
def test_what_does_not_is_named(tmp_path, capsys, fault):
    name, text, message = FAULTS[fault]
    stub = {"sources/two/__init__.pyi": "from .laws import X as X\n"}
    assert lint(tmp_path, FILES | stub | {name: f"{text}\n"}) == 1
    out = capsys.readouterr().out
    assert message in out
    assert name in out or "circle" in fault


def test_an_import_for_type_checking_is_none(tmp_path):
    late = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import flockana.theorems\n"
    assert lint(tmp_path, FILES | {"laws/x.py": late}) == 0


def test_modules_that_import_each_other_are_named_for_type_checking_too(tmp_path, capsys):
    late = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from flockana.laws.b import B\n"
    assert lint(tmp_path, {"laws/a.py": late, "laws/b.py": "from flockana.laws.a import A\n"}) == 1
    assert "import each other in a circle: flockana.laws." in capsys.readouterr().out
