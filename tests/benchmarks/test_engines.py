from benchmarks import engines


def test_what_is_not_installed_is_left_out_with_a_notice(monkeypatch):
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    monkeypatch.setattr(engines, "EVALUATIONS", 2)
    found = engines.study(quick=True)
    assert [notice.partition(":")[0] for notice in found.notices] == ["LAMMPS lj/cut/opt", "OpenMM, CPU platform"]
    assert all(row.baseline == "" for row in found.rows)
