import json

from benchmarks.__main__ import _merged
from benchmarks.page import write
from benchmarks.rows import Asked, Row, to_json

ADAPTIVE = {"adaptive": 1e-3, "adaptive_memory": 5.0}
RECORD = {
    "command": "python -m benchmarks --quick",
    "machine": {"processor": "one that computes", "cores": "2 available"},
    "rows": to_json(
        [
            Row("Pairs", "gas", 1000, 2.0, "ns per pair", "C", 1.2, Asked("<=", 1.5, why="It is met.")),
            Row(
                "Time per pair", "lattice: one evaluation", 10_000, 21.3, "ns per pair", "C, list rebuilt: 17 ns", 1.212
            ),
            Row("Time per pair", "lattice: one evaluation", 10_000, 21.3, "ns per pair", "C, list kept: 11 ns", 1.929),
            Row("Pairs", "lattice", 1000, 2.0, "ns per pair", "C", 1.7, Asked("<=", 1.5, why="C fuses products.")),
        ]
    ),
    "notices": ["no compiler"],
    "series": {
        "cost": [
            {"n": 100, "flow": 1e-5, "step": 1e-4, "flow_memory": 0.0, "step_memory": 1.0} | ADAPTIVE,
            {"n": 1000, "flow": 1e-4, "step": 1e-3, "flow_memory": 1.0, "step_memory": 10.0} | ADAPTIVE,
        ],
        "work-precision": [
            {"method": "RK4", "dt": 0.1, "error": 1e-3, "seconds": 0.1},
            {"method": "RK4", "dt": 0.2, "error": float("inf"), "seconds": 0.05},
        ],
    },
}


def test_page_json_and_pictures_are_written_and_the_page_can_be_written_again(tmp_path):
    paths = write(RECORD, tmp_path)
    assert [path.name for path in paths] == [
        "performance.json",
        "performance.md",
        "performance-cost.png",
        "performance-work-precision.png",
    ]
    page = paths[1].read_text()
    for words in (
        "`python -m benchmarks --quick`",
        "| processor | one that computes |",
        "<summary>Pairs</summary>",
        "- no compiler",
        "| accelerations of 10,000 agents | 1.21\u00a0×\u00a0the\u00a0time | C that finds all pairs anew |",
    ):
        assert words in page
    assert "| gas | 1 000 | 2 ns per pair | C | 1.2 | <= 1.5 | yes |" in page
    assert (
        page.count("Asked for and not reached: 1</summary>\n\n- Pairs, lattice, n = 1 000: ratio 1.7 (against C)") == 1
    )
    assert "asked <= 1.5. C fuses products." in page
    assert "It is met." not in page
    again = write(json.loads(paths[0].read_text()), tmp_path / "again")
    assert again[1].read_text() == page


def test_studies_measured_anew_replace_their_own_rows_only():
    anew = RECORD | {"rows": to_json([Row("Pairs", "gas", 10, 1.0, "s")]), "series": {"cost": []}}
    merged = _merged(RECORD, anew)
    assert [(row["study"], row["n"]) for row in merged["rows"]] == [("Time per pair", 10_000)] * 2 + [("Pairs", 10)]
    assert merged["series"] == RECORD["series"] | {"cost": []}
    assert merged["machine"] == RECORD["machine"]
