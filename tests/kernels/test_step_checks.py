"""What every step must stand up to: balances that halving mends or does not, and poles of the energy."""

from types import SimpleNamespace

import numpy as np
import pytest

from flockana.kernels import step_checks
from flockana.kernels.adaptive_steps import Block

BALANCE = (1e-6, 1e-3)


def residuals(*off, start=8.0):
    """Shares of steps whose balances are off by so much, one after the other, and the ledger."""
    ledger = step_checks.empty_ledger()
    return [step_checks.balanced(start, start + each, 0.0, BALANCE, ledger) for each in off], ledger


def test_a_balance_within_a_share_of_the_largest_energy_or_the_floor_stands():
    shares, ledger = residuals(0.9e-3, start=8.0)
    assert (shares, ledger[step_checks.LARGEST]) == ([1.0], 8.0009)
    assert residuals(1.1e-3, start=8.0)[0] == [0.5]
    assert residuals(1.1e-3, start=2000.0)[0] == [1.0]  # a millionth of it is 2e-3
    assert (
        step_checks.balanced(8.0, 9.0, 1.0, BALANCE, step_checks.empty_ledger()) == 1.0
    )  # what the work explains is no residual


def test_the_largest_energy_so_far_counts():
    ledger = step_checks.empty_ledger()
    assert step_checks.balanced(2000.0, 8.0, -1992.0, BALANCE, ledger) == 1.0
    assert step_checks.balanced(8.0, 8.0, 0.0, BALANCE, ledger) == 1.0
    assert step_checks.balanced(8.0, 8.0011, 0.0, BALANCE, ledger) == 1.0  # a millionth of 2000 is 2e-3


def test_what_halving_mends_is_halved_until_it_stands():
    shares, ledger = residuals(1.0, 0.1, 0.01, 1e-4)
    assert shares == [0.5, 0.5, 0.5, 1.0]
    assert (ledger[step_checks.HALVED], ledger[step_checks.IN_VAIN]) == (0.0, 0.0)


def test_what_four_halvings_leave_is_left_alone_and_in_the_end_not_looked_at():
    ledger = step_checks.empty_ledger()
    for step in range(step_checks.PATIENCE):
        shares = [step_checks.balanced(8.0, 9.0, 0.0, BALANCE, ledger) for _ in range(step_checks.HALVINGS + 1)]
        assert shares == [0.5] * step_checks.HALVINGS + [1.0]
        assert ledger[step_checks.IN_VAIN] == step + 1


def test_a_residual_that_falls_by_much_is_halved_on():
    falls = [1.0, 0.5, 0.3, 0.2, step_checks.FALLS * 0.99, 1e-2]
    shares, ledger = residuals(*falls)
    assert shares == [0.5] * len(falls)
    assert ledger[step_checks.TRIED : step_checks.TRIED + len(falls)] == pytest.approx(falls)


@pytest.mark.parametrize("last", [np.inf, -np.inf, np.nan])
def test_a_step_that_ends_where_the_potential_is_infinite_crossed_a_pole(last):
    ledger = step_checks.empty_ledger()
    assert step_checks.balanced(1.0, last, 0.0, (0.0, np.inf), ledger) == -0.5
    assert not ledger.any()
    assert (
        step_checks.balanced(1.0, 1e300, 0.0, (0.0, np.inf), ledger) == 1.0
    )  # without a tolerance only that is looked at


@pytest.mark.parametrize("share", [-0.5, 0.5, 0.95])
@pytest.mark.parametrize("steps", [1, 2, 5])
@pytest.mark.parametrize("odd", [False, True])
def test_a_fixed_step_is_asked_for_again_only_if_it_then_ends_earlier(share, steps, odd):
    """Half of one rounding may round up to the whole of it again, and for ever."""
    t = np.nextafter(2.5, 3.0) if odd else 2.5
    while True:
        at = t + steps * np.spacing(t)
        block = Block(np.array([t, at]), np.zeros((2, 3)), np.zeros((2, 3)), np.zeros(2))
        rules = step_checks.Rules(True, False, (0.0, np.inf), True)
        judged = step_checks.Judged(
            SimpleNamespace(radii=np.empty((1, 0))), rules, step_checks.empty_ledger(), lambda *_: share
        )
        shorter, singular = step_checks.checked.py_func(block, 0, judged, (0.0, np.zeros(1), np.zeros(1)), None, None)
        if not shorter:
            break
        assert t < t + shorter < at
        steps = round((t + shorter - t) / np.spacing(t))
    assert singular == (share < 0.0)
