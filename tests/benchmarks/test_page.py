import json

from benchmarks.page import write
from benchmarks.rows import Asked, Row, to_json

ADAPTIVE = {"adaptive": 1e-3, "adaptive_memory": 5.0}
RECORD = {
    "command": "python -m benchmarks --quick",
    "machine": {"processor": "one that computes", "cores": "2 available"},
    "rows": to_json(
        [
            Row("Pairs", "gas", 1000, 2.0, "ns per pair", "C", 1.2, Asked("<=", 1.5, why="It is met.")),
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
