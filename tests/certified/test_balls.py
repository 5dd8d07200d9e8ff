"""Integrals in Arb hand on what arrives while they are computed: Arb forgets what its callbacks raise."""

import signal

import pytest
from flint import arb

from flockana.certified.balls import integrate
from tests.programs import posix


def test_an_integral_is_arbs():
    assert integrate(lambda x, analytic: x * x, arb(0), arb(3)).contains(9)


@posix
@pytest.mark.parametrize(("number", "error"), [("SIGINT", KeyboardInterrupt), ("SIGALRM", TimeoutError)])
def test_a_signal_within_an_integral_ends_it(number, error):
    """Within a proof of a basin Ctrl-C was lost as a rule, and the verdict went on to its end."""
    which = getattr(signal, number)
    before = signal.getsignal(which)

    def timed_out(*_):
        raise TimeoutError

    if number == "SIGALRM":
        signal.signal(which, timed_out)

    def interrupted(x, analytic):
        signal.raise_signal(which)
        return x

    try:
        with pytest.raises(error):
            integrate(interrupted, arb(0), arb(1))
    finally:
        signal.signal(which, before)
