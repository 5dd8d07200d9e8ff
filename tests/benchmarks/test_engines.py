"""The engines' side of the comparison, as far as it can be seen without them: that it says what they document."""

import sys
from importlib.machinery import ModuleSpec
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from benchmarks import engines
from benchmarks.flocks import R, gas


@pytest.fixture
def install(monkeypatch):
    def put(name, **contents):
        module = ModuleType(name)
        module.__spec__ = ModuleSpec(name, None)
        vars(module).update(contents)
        monkeypatch.setitem(sys.modules, name, module)

    return put


def test_what_is_not_installed_is_left_out_with_a_notice(monkeypatch):
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    monkeypatch.setattr(engines, "EVALUATIONS", 2)
    found = engines.study(quick=True)
    assert [notice.partition(":")[0] for notice in found.notices] == ["LAMMPS lj/cut/opt", "OpenMM, CPU platform"]
    assert all(row.baseline == "" for row in found.rows)


def test_lammps_is_told_the_flock_the_style_and_the_upkeep_of_its_list(install):
    told = []

    class Lammps:
        def __init__(self, cmdargs):
            self.arguments = cmdargs

        def commands_list(self, lines):
            told.extend(lines)

        def create_atoms(self, n, ids, types, x, v):
            assert (n, len(ids), len(types), len(x), len(v)) == (50, 50, 50, 150, 150)
            assert x[2::3] == v[2::3] == [0.0] * 50
            told.append("atoms")

        def command(self, line):
            told.append(line)

    install("lammps", lammps=Lammps)
    engines.lammps_steps(gas(50))()
    assert told.index("create_box 1 box") < told.index("atoms") < told.index(f"pair_style lj/cut/opt {R}")
    assert "neigh_modify every 1 delay 0 check yes" in told
    assert told[-1] == f"run {engines.EVALUATIONS} pre no post no"


def test_openmm_is_told_the_flock_and_one_thread(install):
    seen = SimpleNamespace(steps=0)

    class Force:
        CutoffNonPeriodic = 1

        def __init__(self):
            self.particles = 0

        def addParticle(self, charge, sigma, epsilon):  # noqa: N802
            assert charge == 0.0
            assert sigma * 2.0 ** (1.0 / 6.0) == pytest.approx(7.0)
            self.particles += 1

        def setNonbondedMethod(self, method):  # noqa: N802
            assert method == 1

        def setCutoffDistance(self, r):  # noqa: N802
            assert r == R

        def setUseDispersionCorrection(self, use):  # noqa: N802
            assert not use

    class System:
        def __init__(self):
            self.masses = []

        def addParticle(self, mass):  # noqa: N802
            self.masses.append(mass)

        def addForce(self, force):  # noqa: N802
            assert force.particles == len(self.masses) == 50

    class Context:
        def __init__(self, system, integrator, platform, properties):
            assert properties == {"Threads": "1"}

        def setPositions(self, x):  # noqa: N802
            np.testing.assert_array_equal(np.array(x)[:, :2], gas(50)[0])

        def setVelocities(self, v):  # noqa: N802
            np.testing.assert_array_equal(np.array(v)[:, :2], gas(50)[1])

        def getState(self, getEnergy):  # noqa: N802
            assert seen.steps == engines.EVALUATIONS

    def step(k):
        seen.steps += k

    install(
        "openmm",
        System=System,
        NonbondedForce=Force,
        Context=Context,
        VerletIntegrator=lambda dt: SimpleNamespace(step=step),
        Platform=SimpleNamespace(getPlatformByName=lambda name: name),
        Vec3=lambda x, y, z: (x, y, z),
    )
    engines.openmm_steps(gas(50))()
    assert seen.steps == engines.EVALUATIONS
