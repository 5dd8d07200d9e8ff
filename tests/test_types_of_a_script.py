"""Scripts as users write them: the documentation's usages are accepted, and refused is what the code refuses."""

import importlib.util
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from shutil import which

import pytest

_GOOD = """
import numpy as np

import flockana as fl

pair = fl.pair_law("k*(s - d)**2*(r - s)**2", adjacency="(1 - s/r)**2", range=3, length=2, parameters={"k": 1.0})
law = fl.Algorithm2(alpha=pair, gains={"c1_alpha": 10.0, "c1_gamma": [1.0, 2.0]}, target=fl.StaticTarget((0.0, 0.0)))
stiffness: float = law.gains.c1_alpha
plain = fl.Algorithm1(gains=fl.Gains(c1_alpha=3.0))
q0 = np.array([[0.0, 0.0], [8.0, 0.0]])
run = fl.simulate(law, q0, [[0, 0], [0, 0]], (0, 5), method=fl.RK4(0.01))
verdict: fl.Verdict = fl.verify("os-1", run)
rows: int = len(fl.verify(law=plain, q0=q0, t_span=[0.0, 5.0]).to_dataframe())
near = fl.claim("near", lambda run: 9.0 - run.metric("cohesion_radius"), statement="all stay near")
names = ["os-1", "energy"]
several: int = len(fl.verify(names, run).to_dataframe()) + len(fl.verify([near, "os-1"], run).rows())
flock = fl.Flock(plain, lambda seed: np.random.default_rng(seed).normal(size=(5, 2)), t_span=(0, 10))
runs = fl.ensemble(flock, range(20), theorems=["energy", near], parameters={"gains.c1_alpha": [1.0, 2.0]})
suffix: str = fl.write_report(flock, "folder", theorems=["energy", near]).suffix
worst = fl.falsify("os-1", law=law, q0=q0, t_span=np.array([0.0, 4.0]), budget=10)
rate: float = fl.linearise(plain, fl.find_equilibrium(plain, q0).q).decay_rate
shares = fl.sample_basin(fl.certify(q0, law=plain), np.array([0.5, 1.0]), runs=4).returned
"""
_WRONG = """import flockana as fl
law = fl.Algorithm1(gains=3.0)
run = fl.simulate(law, [[0.0]], [[0.0]], "0, 5")
fl.verify(law=law, q0=[[0.0]], t_span="0, 5")
fl.ensemble("hexagon", range(3), t_span="0, 5")
name: int = fl.verify("os-1", run).status
fl.Algorithm1(gain={})
fl.Algorithm2(gains={"c1_alpha": 1.0}, target="origin")
fl.veirfy("os-1", run)
"""


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_a_users_script_is_typed(tmp_path, checker):
    package = str(Path(__file__).parents[1])
    (tmp_path / "good.py").write_text(_GOOD)
    (tmp_path / "wrong.py").write_text(_WRONG)
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"extraPaths": [package], "pythonVersion": "3.11"}))
    program = [sys.executable, "-m", checker] if importlib.util.find_spec(checker) else [checker]
    if which(program[0]) is None:
        pytest.skip(f"{checker} is not installed: pip install 'flockana[dev]'")
    options = {
        "mypy": ["--strict", "--config-file=", "--ignore-missing-imports", "."],
        "pyright": ["--pythonpath", sys.executable],
    }
    env = os.environ | {"MYPYPATH": package, "PYTHONPATH": package}
    out = subprocess.run([*program, *options[checker]], cwd=tmp_path, env=env, capture_output=True, text=True).stdout
    refused = re.findall(r"(\w+\.py):(\d+):.*\berror: ", out)
    assert refused == [("wrong.py", str(k)) for k in range(2, 10)], out
