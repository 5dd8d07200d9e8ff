"""Lectures on the wheel: what the checkout has compiled is put beside the installed files, and nothing else is."""

from __future__ import annotations

from pathlib import Path

from tools.run_notebooks import lend_compiled


def written(folder: Path, texts: dict[str, str]) -> Path:
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def test_kernels_are_lent_where_the_package_is_and_where_none_are(tmp_path):
    theirs = {"kernels/__pycache__/a.nbi": "index", "kernels/__pycache__/a.1.nbc": "code", "kernels/a.py": "edited"}
    other = {
        "kernels/__pycache__/a.pyc": "bytecode",
        "kernels/__pycache__/b.nbi": "theirs",
        "gone/__pycache__/c.nbi": "",
    }
    checkout = written(tmp_path / "checkout", theirs | other)
    installed = written(tmp_path / "installed", {"kernels/a.py": "", "kernels/__pycache__/b.nbi": "own"})
    assert lend_compiled(checkout, installed) == 2
    found = {str(path.relative_to(installed)): path.read_text() for path in installed.rglob("*") if path.is_file()}
    assert found == {
        "kernels/a.py": "",
        "kernels/__pycache__/a.nbi": "index",
        "kernels/__pycache__/a.1.nbc": "code",
        "kernels/__pycache__/b.nbi": "own",
    }
