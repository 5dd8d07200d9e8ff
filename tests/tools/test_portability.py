import pytest

from tools import portability
from tools.portability import Row, differences, environments, table, unfit

AVX512 = {
    "machine": "x86_64",
    "libc": "glibc",
    "libm": "new",
    "openblas": {"numpy's": "SkylakeX"},
    "numba": "znver5",
    "numpy": ["X86_V3", "X86_V4", "AVX512_ICL"],
    "processor": ["sse4_2", "avx", "avx2", "fma", "avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"],
}


def test_a_machine_gives_the_environments_that_it_can_run():
    given = environments(AVX512)
    cores = [one["OPENBLAS_CORETYPE"] for name, one in given.items() if name.startswith("blas-")]
    assert cores == ["Prescott", "Nehalem", "Sandybridge", "Haswell", "SkylakeX"]
    # a Haswell has AVX2, so X86_V3 stays; and numba adds the features of the processor at hand unless told not to
    assert given["haswell"] == {
        "OPENBLAS_CORETYPE": "Haswell",
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL",
    }
    assert given["generic"]["NPY_DISABLE_CPU_FEATURES"] == "X86_V3 X86_V4 AVX512_ICL"
    assert given["generic"]["GLIBC_TUNABLES"] == given["libm"]["GLIBC_TUNABLES"]
    small = environments(AVX512 | {"libc": "musl", "processor": ["sse4_2", "avx"], "numpy": ["AVX"]})
    blas = ["blas-prescott", "blas-nehalem", "blas-sandybridge"]
    assert list(small) == [*blas, "numba-generic", "numpy-generic", "generic"]
    assert environments(AVX512 | {"machine": "arm64"}) == {}


@pytest.mark.parametrize(
    ("settings", "here", "reason"),
    [
        ({"OPENBLAS_CORETYPE": "Prescott"}, {"openblas": {"numpy's": "Katmai"}}, ""),
        ({"OPENBLAS_CORETYPE": "Nehalem"}, {}, "asked for the core Nehalem, got {\"numpy's\": 'SkylakeX'}"),
        ({"GLIBC_TUNABLES": "x"}, {}, "libm computes the same"),
        ({"GLIBC_TUNABLES": "x"}, {"libm": "old"}, ""),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["X86_V3"]}, "numpy still uses X86_V3"),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["AVX512_ICL"]}, ""),
        ({"OPENBLAS_CORETYPE": "SkylakeX"}, {}, "this is the machine as it is"),
    ],
)
def test_an_environment_without_its_effect_is_left_out(settings, here, reason):
    found = unfit(settings, AVX512, AVX512 | here)
    assert reason in found
    assert bool(found) is bool(reason)


def verdicts(statuses=(), *, run="complete", expected=(), residual=None):
    return {"run": run, "statuses": dict(statuses), "expected": dict(expected), "residual": residual}


ONE, NONE = {"E": "verified", "E:i": "verified"}, {"E": "verified"}
DEAD = verdicts(run="the child ended with status -4")


@pytest.mark.parametrize(
    ("there", "here", "found"),
    [
        (verdicts(ONE, expected=ONE), verdicts(ONE, expected=ONE), []),
        (verdicts({"E": "x", "E:i": "x"}), verdicts(ONE), [("E", "i", "x", "verified", "")]),
        (verdicts({"E": "x"}, expected=NONE), verdicts(NONE), [("E", "", "x", "verified", "verified")]),
        (verdicts(ONE, expected={"E:i": "refuted"}), verdicts(ONE), [("E", "i", "verified", "verified", "refuted")]),
        (verdicts(NONE), verdicts(ONE), [("E", "i", "missing", "verified", "")]),
        (verdicts(ONE), verdicts(NONE), [("E", "i", "verified", "missing", "")]),
        (DEAD, verdicts(ONE), [("", "run", "the child ended with status -4", "complete", "complete")]),
        (verdicts(run="failed"), verdicts(run="failed"), [("", "run", "failed", "failed", "complete")]),
    ],
)
def test_what_counts_as_changed(there, here, found):
    rows = list(differences("flock", "generic", there, here))
    assert [(row.theorem, row.claim, row.there, row.here, row.expected) for row in rows] == found
    if rows:
        head, line = table(rows).splitlines()
        assert head.split() == list(Row._fields)
        assert head.index("variant") == line.index("generic")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["E99"], "no entry is called E99; there are hexagon, E8"),
        (["--variants", "blas"], "no variant is called blas; there are native, "),
        (["--jobs", "0"], "--jobs 0 --draws 5: expected at least 1 and 0"),
    ],
)
def test_bad_input_is_2_and_says_what_there_is(monkeypatch, capsys, given, message):
    known = AVX512 | {"scenarios": ["hexagon"], "fixed": ["E8"]}
    monkeypatch.setattr(portability, "ask", lambda settings, caches, requests: ([known], ""))
    assert portability.main(given) == 2
    assert message in capsys.readouterr().err


def test_a_moved_start_of_a_small_flock_changes_nothing(capsys):
    """From end to end: two agents that stay far from every threshold, and an erratum that needs no run."""
    assert portability.main(["head-on", "E8", "--variants", "moved-1", "--jobs", "1"]) == 0
    assert "no rows differ: 2 variants of" in capsys.readouterr().out
