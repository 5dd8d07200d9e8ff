"""Root loci and sweeps against roots in closed form."""

from dataclasses import replace

import control
import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, find_equilibrium
from flockana.lattice import hexagonal_spiral
from flockana.stability.delay import delay_margin, scalar_margin
from flockana.stability.gain_sweeps import centre_locus, gain_sweep, margin_sweep
from flockana.stability.law_studies import delay_system, law_blocks
from tests.refused import refused

LINE = StaticTarget((0.0,))
ORIGIN = StaticTarget((0.0, 0.0))


@pytest.mark.parametrize("name", ["c1_gamma", "c2_gamma"])
def test_the_locus_of_the_centre_is_that_of_python_control(name):
    gains, values = Gains(c1_gamma=2.0, c2_gamma=3.0), np.linspace(0.0, 6.0, 13)
    locus, loop = centre_locus(gains, name, values)
    assert isinstance(loop, control.TransferFunction)
    theirs = control.root_locus_map(loop, gains=values).loci
    np.testing.assert_allclose(np.sort_complex(locus.eigenvalues), np.sort_complex(theirs), atol=1e-7)


def test_one_agent_swept():
    """s² + c2γ s + c1γ: the sum and the product of its roots are −c2γ and c1γ at every step."""
    found = gain_sweep(Algorithm2(target=LINE, gains=Gains(c1_gamma=2.0)), [[0.3]], "c2_gamma", [0.5, 1.0, 4.0])
    np.testing.assert_allclose(found.eigenvalues.sum(axis=1), [-0.5, -1.0, -4.0], atol=1e-12)
    np.testing.assert_allclose(found.eigenvalues.prod(axis=1), 2.0, rtol=1e-12)
    np.testing.assert_allclose(found.abscissa, [-0.25, -0.5, -(2.0 - np.sqrt(2.0))], rtol=1e-12)
    assert found.neutral == 0


def test_branches_are_continuous_and_the_neutral_ones_lead():
    law = Algorithm1()
    found = gain_sweep(law, hexagonal_spiral(4, 7.0), "c2_alpha", np.linspace(0.5, 12.0, 60), follow=False)
    assert found.neutral == 5
    assert np.all(found.eigenvalues[:, :5] == 0.0)
    jumps = np.abs(np.diff(found.eigenvalues, axis=0)).max()
    assert jumps < 6.0  # where a pair meets on the real axis it leaves with infinite slope
    assert np.all(found.abscissa < 0.0)


def test_the_equilibrium_is_followed():
    """A pressed pair on a line: shorter by c1γ, and stiffer or softer with it; without following it stays."""
    law, values = Algorithm2(target=LINE, gains=Gains(c1_gamma=0.5)), [0.5, 3.0]
    moved = gain_sweep(law, [[-3.5], [3.5]], "c1_gamma", values)
    stays = gain_sweep(law, [[-3.5], [3.5]], "c1_gamma", values, follow=False)
    pressed = replace(law, gains=replace(law.gains, c1_gamma=3.0))
    there = law_blocks(pressed, find_equilibrium(pressed, [[-3.5], [3.5]]).q).matrix()
    expected = np.sort_complex(np.linalg.eigvals(there))
    np.testing.assert_allclose(np.sort_complex(moved.eigenvalues[1]), expected, rtol=1e-9)
    assert abs(moved.eigenvalues[1] - stays.eigenvalues[1]).max() > 0.5
    for sweep, level in ((moved, 0.5), (stays, 3.0)):
        row = sweep.eigenvalues[values.index(level)]
        drag = law.gains.c2_gamma
        for root in np.roots([1.0, drag, level]):  # the centre of mass, whatever the pair does
            assert abs(row - root).min() < 1e-9


def test_margins_over_a_gain():
    law = Algorithm2(target=LINE, gains=Gains(c2_gamma=1.5))
    found = margin_sweep(law, [[0.0]], "c1_gamma", [0.5, 2.0])
    exact = [scalar_margin(k, 1.5) for k in (0.5, 2.0)]
    np.testing.assert_allclose(found.margins, [x.delay for x in exact], rtol=1e-9)
    np.testing.assert_allclose(found.frequencies, [x.frequency for x in exact], rtol=1e-9)
    pair = margin_sweep(law, [[-3.5], [3.5]], "c1_gamma", [0.5, 3.0]).margins  # the equilibrium is followed
    pressed = replace(law, gains=replace(law.gains, c1_gamma=3.0))
    there = delay_margin(delay_system(pressed, find_equilibrium(pressed, [[-3.5], [3.5]]).q))
    assert pair[1] == pytest.approx(there.delay, rel=1e-9)
    prompt = margin_sweep(law, [[0.0]], "c1_gamma", [0.5], delayed="pairs")
    assert prompt.margins[0] == np.inf  # alone, it hears nobody


test_refusals = refused(
    (lambda: gain_sweep(Algorithm1(), [[0.0]], "c1_gamma", [1.0]), "unknown gain 'c1_gamma'"),
    (lambda: centre_locus(Gains(), "c1_alpha", [1.0]), "nown: c1_gamma, c2_gamma"),
    (lambda: centre_locus(Gains(), "c1_gamma", [2.0, 1.0]), "expected rising gains"),
    (lambda: centre_locus(Gains(), "c1_gamma", []), "expected rising gains"),
    (lambda: centre_locus(Gains(c1_gamma=[1.0]), "c1_gamma", [1.0]), "given per agent"),
    (lambda: centre_locus(3, "c1_gamma", [1.0]), "gains = 3: expected Gains"),
    (lambda: gain_sweep(3, [[0.0]], "c1_gamma", [1.0]), "law = 3: expected Algorithm1"),
    (lambda: margin_sweep(3, [[0.0]], "c1_gamma", [1.0]), "law = 3: expected Algorithm1"),
    (lambda: margin_sweep(Algorithm1(), [[0.0]], "c3", [1.0]), "unknown gain 'c3'"),
)
