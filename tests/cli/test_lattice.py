import importlib
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from flockana import Algorithm1, AlphaInteraction, Trajectory
from flockana.base.errors import SolverError
from flockana.cli.positions_source import BUILDERS, read_source
from flockana.lattice import hexagonal_patch, links
from tests.programs import out_of_a_kernel

COMMAND = ("lattice",)

THEOREMS = importlib.import_module("flockana.theorems")  # flockana.theorems itself is a function


@pytest.fixture
def saved(tmp_path):
    """Two agents that part: 5, 6 and 8 apart, under a law with d = 5 and r = 7."""
    q = np.array([[[0.0, 0.0], [x, 0.0]] for x in (5.0, 6.0, 8.0)])
    law = Algorithm1(AlphaInteraction(d=5.0, r=7.0))
    Trajectory(np.array([0.0, 1.0, 2.0]), q, 0.0 * q, 0.0 * q, law).save(tmp_path / "run.nc")


def test_a_hexagon_of_19_is_measured_exactly(found):
    one = found("hexagonal-spiral:19")
    assert (one["n"], one["m"], one["links"], one["harborth"], one["planar bound"]) == (19, 2, 42, 42, 51)
    assert (one["kind"], one["edge-length error"], one["deviation energy"]) == ("α-lattice", 0.0, 0.0)
    assert (one["shortest link"], one["longest link"], one["d"]) == (7.0, 7.0, 7.0)
    assert one["r"] == pytest.approx(8.4)
    assert one["coordination"] == {"3": 6, "4": 6, "6": 7}
    assert one["defects"] == {"interior": 7, "interior coordination": {"6": 7}, "charge": 0}
    rigid = one["rigidity"]  # 2n − 3 = 35 independent links of 42
    assert (rigid["rank"], rigid["flexes"], rigid["self_stresses"]) == (35, 0, 7)
    assert (one["crossings"], one["planar graph"], one["kuratowski"]) == (0, True, None)
    assert (one["complete"], one["components"], one["verdict"]["status"]) == (False, 1, "verified")


def test_a_block_of_fcc_has_no_crossing_but_no_planar_graph(found):
    one = found("fcc:2x2x2")
    assert (one["n"], one["m"], one["crossings"], one["planar graph"]) == (32, 3, 0, False)
    assert one["kuratowski"]["kind"] in ("K5", "K3,3")
    assert one["kuratowski"]["links"] >= 9
    assert (one["harborth"], one["defects"]) == (None, None)
    assert one["verdict"]["status"] == "refuted"


def test_a_square_bends_and_its_diagonals_cross_once_they_are_links(call, found):
    sides = found("square:2x2")
    assert (sides["links"], sides["rigidity"]["flexes"], sides["crossings"]) == (4, 1, 0)
    all_six = found("square:2x2", "--r", 10)
    assert (all_six["links"], all_six["crossings"], all_six["complete"], all_six["kind"]) == (6, 1, True, "neither")
    assert all_six["edge-length error"] == pytest.approx(7.0 * (np.sqrt(2.0) - 1.0))
    out = " ".join(call("square:2x2")[1].split())
    assert "1 flex; rank 4, 0 self-stresses" in out
    assert "up to κ = 1.4142" in out
    assert "none; each decided exactly" in out
    assert "0 of 7 interior agents without six neighbours, charge 0" in " ".join(call("hexagonal-spiral:19")[1].split())


def test_crossings_are_counted_up_to_what_the_theorems_check_lists(call, found, monkeypatch):
    os_5 = importlib.import_module("flockana.sources.olfati_saber_2006.theorems.theorem_5_planar_nets")
    counted = found("square:12x12", "--r", 20)
    assert (counted["crossings"], counted["crossings listed at most"]) == (15911, os_5.LISTED)
    assert "crossings 15911; each decided" in " ".join(call("square:12x12", "--r", 20)[1].split())
    monkeypatch.setattr(os_5, "LISTED", 200)
    monkeypatch.setattr(importlib.import_module("flockana.lattice.crossings"), "LISTED", 200)
    counted = found("square:6x6", "--r", 20)
    assert (counted["crossings"], counted["crossings listed at most"]) == (200, 200)
    assert "crossings at least 200; each decided" in " ".join(call("square:6x6", "--r", 20)[1].split())


def test_a_run_gives_scale_range_and_the_sample_asked_for(found, saved):
    last = found("run.nc")
    assert (last["d"], last["r"], last["time"], last["links"], last["least distance"]) == (5.0, 7.0, 2.0, 0, 8.0)
    assert (last["kind"], last["edge-length error"], last["components"]) == ("neither", None, 2)
    middle = found("run.nc", "--time", 0.9)
    assert (middle["time"], middle["edge-length error"]) == (1.0, 1.0)
    assert found("run.nc", "--d", 10)["r"] == 14.0  # the law's ratio is kept
    assert found("run.nc", "--r", 9)["links"] == 1


@pytest.mark.parametrize("text", ["x,y\n0,0\n7,0\n", "0,0\n\n7,0\n", "\ufeff0, 0\n7, 0\n", "# x,y\n0,0\n7,0"])
def test_a_csv_is_read_with_and_without_a_header(found, tmp_path, text):
    (tmp_path / "two.csv").write_text(text, encoding="utf-8")
    assert (found("two.csv")["n"], found("two.csv")["longest link"]) == (2, 7.0)


def test_every_builder_is_an_alpha_lattice_at_its_largest_ratio_and_the_scale_is_heeded():
    for name, size in BUILDERS.items():
        given = read_source(f"{name}:" + "x".join("2" for _ in size.split("x")), d=3.0)
        lengths = [np.linalg.norm(given.q[i] - given.q[j]) for i, j in links(given.q, 3.0 * given.max_ratio)]
        np.testing.assert_allclose(lengths, 3.0, rtol=1e-12, err_msg=name)
        assert given.r == pytest.approx(3.6)


@pytest.mark.slow
@pytest.mark.parametrize(("source", "suffix"), [("bcc:1x1x1", "png"), ("line:1", "svg"), ("line:4", "pdf")])
def test_a_picture_is_written_where_it_is_asked_for(call, tmp_path, source, suffix):
    code, out, err = call(source, "--plot", f"it.{suffix}")
    path = tmp_path / f"it.{suffix}"
    assert (code, err) == (0, "")
    assert f"picture: it.{suffix}" in out
    if suffix == "png":
        assert np.ptp(np.asarray(Image.open(path).convert("L"))) > 200
    else:
        assert path.read_bytes()[:5] in (b"%PDF-", b"<?xml")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.csv"], "cannot read none.csv: No such file"),
        (["ragged.csv"], "ragged.csv, line 3: 1 values, expected 2"),
        (["nan.csv"], "nan.csv, line 2: 'nan', expected finite numbers"),
        (["word.csv"], "word.csv, line 2: 'far', expected finite numbers"),
        (["empty.csv"], "empty.csv holds no positions"),
        (["four.csv"], "four.csv has 4 columns: expected 1 to 3"),
        (["bytes.csv"], "cannot read bytes.csv"),
        (["squares:2x2"], "unknown file or builder 'squares'; did you mean 'square'?"),
        (["square:2"], "'square:2': expected square:ROWSxCOLS"),
        (["hexagonal-patch:9999"], "at most 1000000 agents"),
        (["line:3", "--time", "1"], "line:3 is no saved run (.nc)"),
        (["run.nc", "--time", "3"], "--time 3: expected a time of the run, 0 to 2"),
        (["line:3", "--d", "0"], "--d = 0: expected a number > 0"),
        (["line:3", "--plot", "it.bmp"], "it.bmp: expected a file name that ends in .png or .svg or .pdf"),
        (["line:3", "--plot", "word.csv/it.png"], "cannot write to word.csv"),
        (["line:3", "--tol", "0.2"], "--tol 0.2: expected more than 0 and at most 0.1"),
    ],
)
def test_bad_input_is_2_and_one_line(refused, saved, tmp_path, arguments, message):
    texts = {
        "ragged": "x,y\n0,0\n1\n",
        "nan": "0,0\n1,nan\n",
        "word": "0,0\n1,far\n",
        "empty": "x,y\n",
        "four": "1,2,3,4",
    }
    for name, text in texts.items():
        (tmp_path / f"{name}.csv").write_text(text)
    (tmp_path / "bytes.csv").write_bytes(bytes(range(128, 256)))
    refused(message, *arguments)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), out_of_a_kernel()])
def test_ctrl_c_is_130(error, call, monkeypatch):
    def interrupted(*arguments, **options):
        raise error

    monkeypatch.setattr(THEOREMS, "verify", interrupted)
    assert call("line:3") == (130, "", "flockana: interrupted\n")


def test_what_cannot_be_decided_is_said(call, monkeypatch):
    def undecided(*arguments):
        raise SolverError("a zero pivot")

    monkeypatch.setattr("flockana.lattice.rigidity", undecided)
    code, out, _ = call("line:3")
    assert (code, "undecided: a zero pivot" in out) == (0, True)


def test_the_table_fits_in_80_columns_and_help_lists_the_builders(call):
    code, out, _ = call("fcc:2x2x2")
    assert code == 0
    assert max(map(len, out.splitlines())) <= 80
    assert "\x1b" not in out
    shown = call("--help")[1]
    assert all(f"{name}:" in shown for name in BUILDERS)


def test_the_commands_load_nothing_heavy():
    code = (
        "import sys, flockana.cli.lattice, flockana.cli.equilibrium; "
        "print([m for m in ('numpy', 'scipy', 'matplotlib', 'casadi', 'rich.table') if m in sys.modules][:4])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "scipy", "matplotlib", "casadi"} & set(eval(done.stdout))


def test_a_lattice_rounded_to_two_decimals_is_none_until_a_tolerance_says_so(call, found, tmp_path):
    file = tmp_path / "rounded.csv"
    np.savetxt(file, np.round(hexagonal_patch(2, 7.0), 2), delimiter=",", fmt="%.2f")
    verdict = found(file)["verdict"]
    assert (verdict["status"], verdict["author"]) == ("vacuous", "source")
    assert verdict["summary"].startswith(
        "4 of 4 vacuous: 'q is an α-lattice' does not hold; our extension: no two links"
    )
    whose = {claim["name"]: (claim["by"], claim["status"]) for claim in verdict["claims"]}
    assert whose["i"] == ("source", "vacuous")
    assert whose["extension"] == ("flockana", "verified")
    out = " ".join(call(file)[1].split())
    assert "our extension: no two links cross, verified" in out
    assert "--tol 0.0003" in out
    assert found(file, "--tol", "0.0003")["verdict"]["summary"].startswith("4 of 4 verified; our extension: ")
    assert "--tol" not in call("hexagonal-patch:2")[1]


def test_headers_are_respected(found, refused, tmp_path):
    (tmp_path / "id.csv").write_text("id,x,y\n1,0,0\n2,7,0\n3,3.5,6\n")
    assert found("id.csv", "--d", "7")["m"] == 2
    (tmp_path / "v.csv").write_text("x,y,vx\n0,0,1\n7,0,1\n")
    refused("expected vy too", "v.csv")
    (tmp_path / "t.csv").write_text("time,id,x,y\n0,1,0,0\n")
    refused("observe reads recordings", "t.csv")
