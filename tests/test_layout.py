"""Tests mirror the package: tests/<room>/test_<module>.py tests flockana/<room>/<module>.py."""

from pathlib import Path

TESTS = Path(__file__).parent
ACROSS = ("adversarial", "bad_input", "properties", "reference")  # folders of tests that are about no one module
OUTSIDE = ("benchmarks", "proofs", "tools")  # folders of tests of what stands beside the package


def test_each_file_is_named_for_the_module_that_it_tests():
    root, lost = TESTS.parent, []
    for path in TESTS.glob("*/**/test_*.py"):
        room = path.parent.relative_to(TESTS)
        if room.parts[0] in ACROSS:
            continue
        tested = (root if room.parts[0] in OUTSIDE else root / "flockana") / room / path.stem.removeprefix("test_")
        if not (tested.with_suffix(".py").exists() or tested.is_dir()):
            lost.append(str(path.relative_to(root)))
    assert lost == []
