import sys

COMMAND = ("explore",)


def test_an_unknown_name_or_a_bad_file(call, tmp_path):
    code, out, err = call("hexagn")
    assert (code, out) == (2, "")
    assert "did you mean 'hexagon'" in err
    assert len(err.splitlines()) == 1
    (tmp_path / "run.nc").write_text("none")
    assert call("run.nc")[0] == 2
    (tmp_path / "found.json").write_text("{}")
    assert "holds no counterexample" in call("found.json")[2]
    assert call("hexagon", "--seconds", "0")[0] == 2


def test_without_the_extra_the_remedy_is_said(call, monkeypatch):
    monkeypatch.setitem(sys.modules, "tornado.httpserver", None)
    monkeypatch.delitem(sys.modules, "flockana.explore.page_server", raising=False)
    code, _, err = call("hexagon")
    assert code == 2
    assert "pip install 'flockana[explore]'" in err
    assert len(err.splitlines()) == 1
