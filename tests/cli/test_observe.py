import pandas as pd
import pytest

from flockana.recorded.faulty_laws import faulty_recording

COMMAND = ("observe",)


@pytest.fixture(scope="module")
def tracks(tmp_path_factory):
    rec, path = faulty_recording("B").window(0.0, 0.6), tmp_path_factory.mktemp("tracks") / "b.csv"
    rows = [(t, i, *rec.q[k, i], *rec.p[k, i]) for k, t in enumerate(rec.t) for i in range(rec.n)]
    pd.DataFrame(rows, columns=["time", "id", "x", "y", "vx", "vy"]).to_csv(path, index=False)
    return path


def test_a_recording_is_measured_and_definitions_are_judged_without_a_law(call, tracks, tmp_path):
    code, out, err = call(tracks, "--d", "7", "--bound", "1e-6", "-o", "page.html")
    assert (code, err) == (0, "")
    assert "R, cohesion radius" in out
    assert "± 2e-06" in out
    assert "alpha-flocking" in out
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "flockanaPlayer" in text
    assert "http" not in text.split("</style>")[1].split("<script")[0].replace("http://www.w3.org", "")


def test_a_law_is_held_against_it_with_findings_and_exit_status_3(call, tracks):
    code, out, _ = call(tracks, "--law", "algorithm-1", "--bound", "1e-6")
    assert code == 3
    assert "finding: velocity consensus is c2α" in out
    assert "the samples follow the law: unmet" in out
    assert max(map(len, out.splitlines())) <= 80


def test_a_formula_is_a_law_and_json_holds_everything(found, tracks):
    data = found(tracks, "--d", "7", "--r", "8.4")
    assert len(data["time"]) == 31
    assert len(data["measures"]["cohesion_radius"]) == 31
    assert {verdict["theorem"] for verdict in data["verdicts"]} >= {"alpha-flocking", "os-5-terminal"}


def test_bad_input_is_one_line(refused, tracks):
    refused("no file nothing.csv", "nothing.csv", "--d", "7")
    refused("expected --law NAME, or --d", tracks)
    refused("--fit: expected --law or --formula", tracks, "--d", "7", "--fit")
    refused("expected one of them", tracks, "--law", "algorithm-1", "--formula", "s")
    refused("unknown scenario 'nobody'", tracks, "--law", "nobody")
    refused("expected --d and --r", tracks, "--formula", "s**2")


def test_clocks_and_the_dimension_are_options(call, refused, tmp_path):
    rows = [(0.1 * k + 0.03 * i, i, k, 2.0 * i, 0.0) for k in range(20) for i in range(2)]
    path = tmp_path / "it.csv"
    pd.DataFrame(rows, columns=["t", "id", "x", "y", "z"]).to_csv(path, index=False)
    refused("are sampled at other times", path, "--d", "2")
    for options, said in (
        (("--jitter", "0.05"), "m = 2, 20 samples"),
        (("--interpolate", "1"), "m = 2, 20 samples, t = 0 to 1.9, 1 gaps"),
        (("--interpolate", "0"), "m = 2, 40 samples"),
    ):
        code, out, _ = call(path, "--d", "2", "--m", "2", "--bound", "0.01", *options)
        assert code == 0
        assert said in " ".join(out.split())


@pytest.mark.slow
def test_gains_are_fitted_for_a_formula_too(call, tracks):
    code, out, _ = call(tracks, "--formula", "(s**2-d**2)**2/1e3", "--d", "7", "--r", "8.4", "--fit", "--json")
    assert code in (0, 3)
    assert '"c1_alpha"' in out


def test_refusals_name_the_options_of_the_command(refused, tmp_path):
    (tmp_path / "odd.csv").write_text("a,b,c\n1,2,3\n", encoding="utf-8")
    refused("name them by --columns t=NAME,id=NAME,q=NAME+NAME,p=NAME+NAME", "odd.csv")
    (tmp_path / "frames.csv").write_text("frame,id,x,y\n0,0,0,0\n0,1,7,0\n1,0,0,1\n1,1,7,1\n", encoding="utf-8")
    refused("--dt ", "frames.csv", "--d", "7")
    refused("--columns has 2 names", "frames.csv", "--columns", "t,x")


def test_numbers_that_stand_for_not_seen_and_names_in_order_are_options(call, refused, tmp_path):
    rows = [
        f"{k},{i},{7 * i + 0.01 * k},{-9999 if (k, i) == (3, 1) else 0.02 * k}" for k in range(12) for i in range(2)
    ]
    rows = [row.replace("7.03,-9999", "-9999,-9999") for row in rows]
    (tmp_path / "it.csv").write_text("when,kite,east,north\n" + "\n".join(rows) + "\n", encoding="utf-8")
    options = ("it.csv", "--columns", "t,id,x,y", "--d", "7", "--bound", "0.01")
    refused("--missing -9999, or --missing none if", *options)
    code, out, err = call(*options, "--missing", "-9999")
    assert (code, err) == (0, "")
    assert "1 positions that are -9999 are gaps" in out
    assert "columns= replaces the header: 'when' is 't'" in out
    assert call(*options, "--missing", "none")[0] == 0
    refused("--missing 1,a: expected numbers", *options, "--missing", "1,a")


def test_a_law_of_a_file(call, tracks, refused, tmp_path):
    law = "import flockana as fl\n\nlaw = fl.Algorithm1()\nq = 1\nflock = fl.Flock(law, [[0.0], [7.0]])\n"
    (tmp_path / "mine.py").write_text(law, encoding="utf-8")
    known = call(tracks, "--law", "algorithm-1", "--bound", "1e-6")
    for name in ("law", "flock"):
        assert call(tracks, "--law", f"mine.py:{name}", "--bound", "1e-6") == known
    refused("mine.py:q is 1: expected a law; fl.compose(...) makes one", tracks, "--law", "mine.py:q")
