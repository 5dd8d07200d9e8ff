"""A pair law from a formula: against mpmath, against the hand-written law, and in every part of the library."""

import dataclasses
import json
import pickle
import re
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import mpmath
import numpy as np
import pytest
import sympy as sp

import flockana as fl
from flockana.base.errors import ArgumentError, FileError
from flockana.base.serialize import from_data, to_data
from flockana.interactions import AlphaInteraction
from flockana.kernels.sine_and_cosine import cosine, sine
from tests.refused import refused
from tests.toys.formulas import alpha_formula, formula_flock, spring

PAPER = AlphaInteraction()


def values(law, s):
    """(w, dw/ds², ψ) by the generated functions at distances s, interpreted: what numba makes of them is no other."""
    kernels, found = law.kernels, []
    for square in (np.float64(x) ** 2 for x in s):
        at = (*kernels.norm(square, law.par), law.par) if kernels.norm else (square, law.par)
        energy = kernels.energy_of_pair(square, law.par, law.panels)
        found.append((kernels.pair(*at)[0], kernels.slope_of_pair(square, law.par), energy))
    return np.array(found).T


@pytest.mark.parametrize("x", [-7.0, -1.6, 0.0, 1e-9, 0.7, np.pi / 2, 3.0, 41.0, 1e4 + 0.3, 999_999.7, -999_997.2])
def test_sine_and_cosine(x):
    assert sine(x) == pytest.approx(float(mpmath.sin(x)), abs=3e-16)
    assert cosine(x) == pytest.approx(float(mpmath.cos(x)), abs=3e-16)


def test_the_papers_law_as_a_formula_is_the_papers_law():
    law = alpha_formula()
    s = np.linspace(0.0, 8.4, 400)
    rng = np.random.default_rng(1)
    q, p = rng.uniform(0.0, 40.0, (60, 2)), rng.normal(size=(60, 2))
    assert np.abs(law.energy(s) - PAPER.energy(s)).max() < 1e-13 * PAPER.c_star
    assert law.far_potential == pytest.approx(PAPER.far_potential, rel=1e-13)
    assert (law.faults, law.lattice, law.strength) == ((), (7.0, 8.4), pytest.approx(PAPER.strength, rel=1e-4))
    laws = [fl.Algorithm1(pair) for pair in (law, PAPER)]
    u, stated = (each.acceleration(0.0, q, p) for each in laws)
    assert np.abs(u - stated).max() < 1e-13 * PAPER.strength
    mine, theirs = (each.jacobian(0.0, q, p) for each in laws)
    assert np.abs(mine - theirs).max() < 1e-12 * np.abs(theirs).max()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("potential", "parameters"),
    [
        ("cos(s/k)", {"k": 0.7}),
        ("(1 - exp(-s**2))/s**2", {}),
        ("sin(s)/s", {}),
        ("exp(-s**2/k)", {"k": 2.0}),
        ("sin(z)/z", {"eps": 0.1}),
        ("cos(pi*s)", {}),
        ("cos(1.37*s)", {}),
    ],
)
def test_removable_singularities_lose_no_digit(potential, parameters):
    law = fl.pair_law(potential, adjacency=0, range=3.0, length=1.0, parameters=parameters)
    s = 3.0 * 0.5 ** np.arange(1.0, 60.0)
    assert law.coincidence

    def psi(x):
        z = (mpmath.sqrt(1 + mpmath.mpf("0.1") * x) - 1) / mpmath.mpf("0.1")
        names = {"s": mpmath.sqrt(x), "z": z, **{k: mpmath.mpf(v) for k, v in parameters.items()}}
        known = {"cos": mpmath.cos, "sin": mpmath.sin, "exp": mpmath.exp, "pi": mpmath.pi}
        return eval(potential, known, names)  # of this test's own

    w, slope, energy = values(law, s)
    with mpmath.workdps(200):
        exact = [
            [float(k * mpmath.diff(psi, mpmath.mpf(x) ** 2, n, h=mpmath.mpf(10) ** -90)) for x in s]
            for n, k in ((1, 2), (2, 2))
        ]
        energies = [float(psi(mpmath.mpf(x) ** 2)) for x in s]
    assert np.abs(w - exact[0]).max() < 1e-14 * np.abs(exact[0]).max()
    assert np.abs(slope - exact[1]).max() < 1e-12 * np.abs(exact[1]).max()
    assert np.abs(energy - energies).max() < 1e-14 * np.abs(energies).max()
    assert np.isfinite(values(law, [0.0])).all()


def test_a_force_is_integrated():
    law = fl.pair_law(force="sin(s)", adjacency=0, range=3.0, length=1.0)
    s = np.linspace(0.0, 4.0, 50)
    assert law.energy(s) == pytest.approx(np.cos(1.0) - np.cos(np.minimum(s, 3.0)), abs=1e-14)


FAULTS = [
    ("s**2*(s - r)**2", "(1 - s/r)", ()),
    ("1/s + s", 0, ("coincidence is excluded", "does not vanish at the range")),
    ("s**2/(r - s)", 0, ("pole at the range",)),
    ("Piecewise((s**2, s < 1), (2*s - 1, True))", 0, ("the force does not vanish",)),
    ("Piecewise((s**2, s < 1), (s, True))", 0, ("the force jumps at s = 1", "does not vanish at the range")),
    ("Piecewise((1, s < 2), (0, True))", 0, ("the potential jumps at s = 2",)),
    ("0", 1, ("the adjacency does not vanish",)),
    ("0", "Piecewise((1, s < 2), (0, True))", ("the adjacency jumps at s = 2",)),
    ("abs(s - 1)*(s - r)**2*s**2", 0, ("the force jumps at s = 1",)),
]


@pytest.mark.slow
@pytest.mark.parametrize(("potential", "adjacency", "faults"), FAULTS)
def test_what_a_formula_lacks_is_named(potential, adjacency, faults):
    law = fl.pair_law(potential, adjacency=adjacency, range=3.0, length=1.0)
    assert len(law.faults) == len(faults)
    assert all(part in fault for part, fault in zip(faults, law.faults, strict=True))


GOOD = {"potential": "s**2", "adjacency": 0, "range": 3.0, "length": 1.0}
test_bad_formulas = refused(
    ({"parameters": 3}, "parameters = 3: expected a dictionary"),
    ({"units": 3}, "units = 3: expected a dictionary"),
    ({"units": {"k": 3}}, r"units\['k'\] = 3: expected whole powers"),
    ({"units": {"k": (1, 0.5)}}, r"units\['k'\] = \(1, 0.5\): expected whole powers"),
    ({"potential": "k*s"}, "unknown name 'k': expected one of d, d_z, pi, r, "),
    ({"parameters": {"q": 1.0}}, "'q' is in no formula"),
    ({"parameters": {"s": 1.0}}, "a name that has no meaning of its own"),
    ({"parameters": {"a b": 1.0}}, "'a b'"),
    ({"potential": "k*s", "parameters": {"k": float("nan")}}, "k"),
    ({"potential": None}, "one of the two"),
    ({"force": "s"}, "one of the two"),
    ({"length": 5.0}, "length within the range"),
    ({"range": -1.0}, "range = -1: expected a number > 0"),
    ({"potential": "s*z", "parameters": {"eps": 0.1}}, "in s and in z"),
    ({"potential": "z"}, "eps"),
    ({"potential": "z", "parameters": {"eps": -1.0}}, "eps"),
    ({"potential": "log(s - 2)"}, "no finite real value at s = "),
    ({"potential": "1/(s - 1.5)"}, "no finite real value at s = 1.5"),
    ({"potential": "Piecewise((1, s**2 < 2), (0, True))"}, "not linear in s"),
    ({"potential": "Piecewise((1, s < 2))"}, "no piece holds"),
    ({"potential": object()}, "expected a sympy expression"),
    ({"potential": None, "force": "1/s"}, "cannot be integrated"),
    ({"units": {"k": (1, 0)}}, "units of 'k'"),
    make=lambda **change: fl.pair_law(**(GOOD | change)),
)


@pytest.mark.slow
@pytest.mark.parametrize(
    "formula",
    ["exp(exp(1e9*s))", "exp(exp(exp(s)))", "*".join(f"sin({k}*s)" for k in range(1, 60)), "sin(" * 90 + "s" + ")" * 90,
     "*".join(f"(s + {k})" for k in range(45)),
     "Piecewise(" + "".join(f"({k}, s < {0.01 * k}), " for k in range(1, 80)) + "(0, True))"],
    ids=["double exponential", "triple exponential", "factors", "nested", "product", "pieces"],
)  # fmt: skip
def test_short_formulas_that_grow_are_refused_by_counts(formula):
    """None of them takes long, and each is answered by an error with a remedy."""
    with pytest.raises(ArgumentError, match="expected"):
        fl.pair_law(formula, adjacency=0, range=3.0, length=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["mpf", "lambda_", "mpmath", "x0", "inf", "nan", "par", "root_", "max"])
def test_a_parameter_may_have_any_name(name):
    assert fl.pair_law(f"{name}*s", adjacency=0, range=3.0, length=1.0, parameters={name: 2.0}).force(1.0) == -2.0
    law = fl.pair_law(f"{name}*s**2", adjacency=0, range=3.0, length=1.0, parameters={name: 2.0})
    assert law.force(1.0) == -4.0
    assert law.facts.least[0] == 0.0


def test_the_root_of_a_square_has_two_pieces():
    law = fl.pair_law("sqrt((s - 1.3)**2)*(r - s)**2", adjacency=0, range=3.0, length=1.0)
    assert law.surfaces == (1.3, 3.0)
    assert law.energy([0.3, 2.3]) == pytest.approx([2.7**2, 0.7**2], rel=1e-14)


def test_parameters_are_given_later_and_compile_nothing():
    law = spring()
    other = law.with_parameters(k=2.0)
    assert other.kernels is law.kernels
    assert other.force(2.5) == pytest.approx(2.0 / dict(law.parameters)["k"] * law.force(2.5))
    with pytest.raises(ArgumentError, match="'m' is no parameter"):
        law.with_parameters(m=1.0)


def test_sympy_and_text_are_one():
    s, d, r, k = sp.symbols("s d r k")
    law = fl.pair_law(
        k * (s**2 - d**2) ** 2 * (r**2 - s**2) ** 2,
        adjacency=(1 - s / r) ** 2,
        range=3.0,
        length=2.0,
        parameters={"k": 0.01},
    )
    at = np.linspace(0.0, 3.0, 20)
    assert law.force(at) == pytest.approx(spring().force(at), abs=1e-13)


def test_units():
    law = spring()
    other = fl.rescale(law, length=1000.0, time=60.0)
    assert other.force(2000.5) == pytest.approx(law.force(2.0005) * 1000.0 / 3600.0, rel=1e-9)
    assert fl.rescale(alpha_formula(), length=3.0).d == 21.0
    with pytest.raises(ArgumentError, match="'k' has no powers"):
        fl.rescale(dataclasses.replace(law, powers=()), length=2.0)
    with pytest.raises(ArgumentError, match="a number in it that has a unit"):
        fl.rescale(dataclasses.replace(law, potential=law.potential.replace("d**2", "4")), length=2.0)


def test_a_file_holds_text_and_numbers():
    law = spring()
    data = json.loads(json.dumps(to_data(law)))
    assert from_data(data) == law
    assert pickle.loads(pickle.dumps(law)) == law  # as processes hand it on
    with pytest.raises(FileError, match="is no formula"):
        from_data(data | {"potential": "().__class__"})
    with pytest.raises(FileError, match="power beyond 64"):
        from_data(data | {"adjacency": "9**9**9**9"})


@pytest.mark.slow
def test_it_is_a_pair_law_everywhere(tmp_path):
    law = fl.Algorithm2(spring(), fl.Gains(c1_gamma=0.5), fl.StaticTarget((0.0, 0.0)))
    rng = np.random.default_rng(3)
    q, p = np.array([[0.0, 0.0], [2.2, 0.0], [1.0, 1.8]]), rng.normal(0.0, 0.1, (3, 2))
    assert law.compiled(2) is not None
    run = fl.simulate(law, q, p, (0.0, 2.0))
    assert np.abs(run.energy_residual).max() < 1e-6 * np.abs(run.energy()).max()
    run.save(tmp_path / "run.npz")
    again = fl.Trajectory.load(tmp_path / "run.npz")
    assert again.law == law
    rest = fl.find_equilibrium(law, q)
    modes = fl.linearise(law, rest)
    assert modes.eigenvalues.real.max() < 1e-6


@pytest.mark.slow
def test_ensembles_rebuild_the_law_in_other_processes():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as other:
        found = fl.ensemble(formula_flock, [0, 1], executor=other, theorems=[], metrics=["order"])
    assert found.sizes["seed"] == 2
    assert not [text for text in found["error"].values.ravel().tolist() if text]


@pytest.mark.slow
def test_falsification_varies_a_formula_s_flock():
    result = fl.falsify("energy", formula_flock(0), budget=2, seed=1)
    assert result.claim in ("rate", "balance")
    assert "refuted" not in {status for each in result.statuses.values() for status in each}


def test_derivation():
    derived = spring().derivation()
    assert derived.holds
    assert r"\psi" in derived.latex()
    law = fl.Algorithm1(spring())
    identity = law.derivation(1)
    assert identity.holds
    assert "Algorithm1" in identity.latex()
    assert fl.Algorithm2(target=fl.StaticTarget((0.0,))).derivation(1).holds
    with pytest.raises(ArgumentError, match="expected pair_law"):
        fl.Algorithm1(fl.DeadZoneInteraction()).derivation()


@pytest.mark.parametrize("length", [1.0, 2.0])
def test_the_strength_of_a_force_without_bound_is_its_largest_from_half_the_distance_on(length):
    """|1 - d²/s²| falls from 3 at d/2 to 0 at d and rises to 1 - d²/9 at the range."""
    pair = fl.pair_law("d**2/s + s", adjacency=0, range=3.0, length=length)
    assert pair.strength == pytest.approx(3.0, rel=0.03)


@pytest.mark.parametrize(("share", "jumps"), [(1e-8, True), (1e-10, False)])
def test_a_jump_of_the_potential_is_one_by_the_scale_of_force_times_range(share, jumps):
    """The force is 7.5e5 at half the distance and the range 1e-3: 750 is the energy to compare with."""
    height = share * 750.0
    text = f"Piecewise((0.5*k*(s - r)**2 + {height!r}, s < 0.0005), (0.5*k*(s - r)**2, True))"
    law = fl.pair_law(text, adjacency=0, range=1e-3, length=5e-4, parameters={"k": 1e9})
    assert law.strength == pytest.approx(7.5e5, rel=0.02)
    assert any("the potential jumps" in fault for fault in law.faults) is jumps


def test_a_series_stands_in_only_where_the_formula_loses_digits():
    """sin(s)/s is 0/0 at 0; a polynomial is computed as it stands down to 0."""
    bounds = [
        fl.pair_law(potential, adjacency=0, range=3.0, length=1.0).par[3]  # below it the series holds
        for potential in ("s**2*(s - r)**2", "0.25*(r**2 - s**2)**2", "sin(s)/s")
    ]
    assert bounds[:2] == [0.0, 0.0]
    assert bounds[2] > 0.0
    in_z = fl.pair_law("z*(z - 1)**2*(z - 2)", parameters={"eps": 0.1}, adjacency=0, range=3.0, length=1.0)
    assert in_z.par[3] == 0.0


@pytest.mark.parametrize(("d", "r"), [(2.9985, 3.0), (0.29985, 0.3), (7.0, 8.4)])
def test_a_force_that_attracts_up_to_a_range_just_above_the_distance_only_has_a_lattice(d, r):
    """Above the range the formula repels again, which no pair feels."""
    pulls, pushes = (fl.pair_law(force=f"{sign}(s - d)*(r - s)", adjacency=0, range=r, length=d) for sign in ("", "-"))
    assert pulls.lattice == (d, r)
    assert pushes.lattice is None


@pytest.mark.parametrize(("force", "lattice"), [("sin(4*(s - 1))", (1.0, 3.0)), ("sin(4*(1 - s))", None)])
def test_a_force_that_turns_again_further_out_holds_at_the_distance_all_the_same(force, lattice):
    """At 2 it pushes where at 1.001 it pulls."""
    assert fl.pair_law(force=force, adjacency=0, range=3.0, length=1.0).lattice == lattice


@pytest.mark.parametrize(
    ("adjacency", "vanishes"),
    [("1e6*(r - s) + 1e-5", True), ("1e6*(r - s) + 1", False), ("1e-12*(r - s)", True), ("1e-12*(1 + r - s)", False)],
)
def test_an_adjacency_vanishes_at_the_range_by_its_own_scale(adjacency, vanishes):
    law = fl.pair_law("s**2*(s - r)**2", adjacency=adjacency, range=3.0, length=1.0)
    assert ("the adjacency does not vanish at the range, s = 3" not in law.faults) is vanishes


def test_a_weight_that_is_a_number_is_declared_where_it_is_read():
    law = fl.pair_law("0.37*s**2", adjacency=0.25, range=3.0, length=1.0)
    assert values(law, [2.0])[0] == pytest.approx(2.0 * 0.37, rel=1e-15)


def test_the_strength_of_a_force_that_acts_below_half_the_distance_only_is_its_largest():
    """It has no bound where agents meet and is 0 from 0.1 on; the adjacency, which is 7, is no force."""
    text = "Piecewise((s + 1/s*0.01, s < 0.1), (0.2, True))"
    pair = fl.pair_law(text, adjacency=7, range=3.0, length=2.0)
    assert pair.strength > 50.0


WELL = "k*((r**2 - s**2)**4/8 - (r**2 - d**2)*(r**2 - s**2)**3/6)"
TWICE = (
    "k*(s**2 - d**2)**2*(r**2 - s**2)**2"  # its force is 4 k s (s² − d²)(r² − s²)(r² + d² − 2s²): another zero at √6.5
)


@pytest.mark.parametrize(
    ("potential", "adjacency", "zeros", "remarks"),
    [
        (WELL, "(1 - s/r)**2", (2.0,), []),
        (
            TWICE,
            "(1 - s/r)**2",
            (2.0, 6.5**0.5),
            ["changes sign again at s = 2.54951: beyond, agents repel each other"],
        ),
        ("k*(s - d)**2", "0", (2.0,), ["the force jumps from -0.02 to 0 at the range, s = 3"]),
        ("k*(r - s)**2", "1", (), ["the adjacency jumps from 1 to 0 at the range, s = 3"]),
        (
            "k*(r - s)**2/(s - 1)**2",
            "0",
            None,
            ["changes sign again at s = 1", "the force is infinite at s = 1, within"],
        ),
    ],
)
def test_what_a_law_lacks_is_said_when_it_is_made(potential, adjacency, zeros, remarks):
    numbers = {"adjacency": adjacency, "range": 3.0, "length": 2.0, "parameters": {"k": 0.01}}
    if remarks:
        with pytest.warns(fl.PairLawWarning, match=re.escape(remarks[0])):
            law = fl.pair_law(potential, **numbers)
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            law = fl.pair_law(potential, **numbers)
    assert len(law.remarks) >= len(remarks)
    assert all(any(remark in given for given in law.remarks) for remark in remarks)
    assert all(given in repr(law) for given in law.remarks)
    assert not any("infinite" in given for given in law.remarks) or "(s - 1)" in potential
    if zeros is not None:
        assert law.facts.zeros == pytest.approx(zeros, rel=1e-12)


def test_a_caret_is_no_power():
    with pytest.raises(
        ArgumentError, match=re.escape("'k*s^2' has a ^, which is no power here; expected **, as in 'k*s**2'")
    ):
        fl.pair_law("k*s^2", adjacency=0, range=3.0, length=1.0, parameters={"k": 1.0})


@pytest.mark.slow
@pytest.mark.parametrize("width", ["1e-3", "1e-5"])
def test_a_steep_logistic_switch_is_computed_without_overflow(width):
    """1/(1 + exp(−(s − 1)/w)) = (1 + tanh((s − 1)/2w))/2, whose slope is sech²/4w."""
    law = fl.pair_law("0", adjacency=f"1/(1 + exp(-(s - 1)/{width}))", range=3.0, length=1.0)
    w, s = float(width), np.array([0.01, 0.5, 1.0, 1.0 + 3.0 * float(width), 2.0])
    values = law.values(s)
    x = np.minimum(np.abs(s - 1.0) / (2.0 * w), 300.0)
    assert values.adjacency == pytest.approx(0.5 + 0.5 * np.tanh((s - 1.0) / (2.0 * w)), abs=4e-16 / w)  # of √s²
    assert values.adjacency_slope == pytest.approx(0.25 / w / np.cosh(x) ** 2, rel=1e-9, abs=1e-15 / w**2)
    assert law.facts.weight.status == "met" or w < 1e-4  # there it is left open
