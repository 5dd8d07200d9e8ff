import pytest

COMMAND = ("export",)


def test_a_scenario_is_written_and_what_is_missing_is_said(call, tmp_path):
    code, said, _ = call("lammps", "hexagon", "-o", "new", "--samples", 5, "--points", 500)
    assert code == 0
    assert "missing: velocity consensus" in said
    assert "table: force off by at most" in said
    for name in ("in.flock", "flock.data", "pair.table", "README.txt"):
        assert f"{name}: new/{name}" in said
        assert (tmp_path / "new" / name).exists()
    assert "N 500 RSQ" in (tmp_path / "new" / "pair.table").read_text()


@pytest.mark.slow
def test_the_nearest_consensus_can_be_chosen(call, tmp_path):
    code, said, _ = call("lammps", "hexagon", "-o", tmp_path, "--consensus", "nearest")
    assert code == 0
    assert "nearly: velocity consensus" in said
    assert "dpd/ext/tstat" in (tmp_path / "in.flock").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"), [(("lammps", "minimal-2d"), "has no pair term for LAMMPS to tabulate")]
)
def test_bad_input_is_told_and_nothing_is_written(call, tmp_path, arguments, message):
    code, _, error = call(*arguments, "-o", "new")
    assert code == 2
    assert message in error
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("name", "text"),
    [("in.flock", ""), ("flock.data", "my own\n"), ("pair.table", "\n" * 2000), ("README.txt", "3 agents of mine\n")],
)
def test_another_s_file_is_kept(refused, tmp_path, name, text):
    (tmp_path / name).write_text(text)
    refused(
        f"{name} exists and is not from an export for LAMMPS: nothing is written, so that it is kept; choose "
        "another folder, or move it away",
        *("lammps", "hexagon", "-o", tmp_path, "--points", 50),
    )
    assert (tmp_path / name).read_text() == text
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_an_export_from_before_is_replaced(call, tmp_path):
    for scenario in ("hexagon", "three-agents-1d"):
        assert call("lammps", scenario, "-o", tmp_path, "--points", 50)[0] == 0
    assert "3 agents" in (tmp_path / "README.txt").read_text()
