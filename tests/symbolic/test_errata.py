"""The friends' form of the gradient part: true, as printed, written out for few friends, and mutants."""

import pytest
import sympy as sp

from flockana.symbolic import errata
from flockana.symbolic.errata import FRIENDS, NEGATIVE, OWN, PLACE, SHIFT, STRESS, friends_form, gradient_part


def written_out(expression, positive, negative):
    sized = expression.subs({FRIENDS: positive, NEGATIVE: negative})
    return sp.expand(sized.replace(lambda e: isinstance(e, sp.Sum), lambda e: e.doit()))


@pytest.mark.parametrize(("positive", "negative"), [(1, 1), (2, 1), (3, 2)])
def test_few_friends_written_out(positive, negative):
    friends = range(1, positive + negative + 1)
    force = sp.expand(sum(STRESS[j] * (PLACE[j] - OWN) for j in friends))
    lost = sp.expand(-OWN * sum(STRESS[j] for j in friends))
    assert written_out(gradient_part(), positive, negative) == force
    assert written_out(friends_form(printed=False), positive, negative) == force
    assert written_out(gradient_part() - friends_form(printed=True), positive, negative) == lost


def test_what_is_lost_is_what_translation_shows():
    """−S_i q_i is left over, and moving by w adds S_i w: the same S_i."""
    left, moved = errata.reynolds_form(printed=True).residuals
    assert sp.expand(left.subs(OWN, SHIFT) + moved) == 0
    assert left != 0


def test_another_force_is_not_that_form(monkeypatch):
    monkeypatch.setattr(errata, "gradient_part", lambda: 2 * gradient_part())
    assert not errata.reynolds_form().holds
