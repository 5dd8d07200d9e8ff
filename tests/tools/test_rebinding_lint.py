from textwrap import dedent, indent

import pytest

from tools.rebinding_lint import findings, main

WRONG = {
    "q = q.shape[0]": "q is an array, and then a number",
    "q = np.empty(3)": "the argument q is bound again, to an array of its own",
    "a = np.empty(3)\na = 0": "a is an array, and then a number",
    "n = len(q)\nn = np.zeros(2)": "n is a number, and then an array",
    "for q in range(3):\n    pass": "the loop counts with q, an argument or an array",
    "a = np.zeros(3)\nfor k in range(3):\n    for a in range(2):\n        pass": "the loop counts with a, an argument",
    "for k in range(3):\n    for j in range(2):\n        for k in range(4):\n            p": "as a loop around",
    "for k in range(3):\n    k = 2": "k is bound in the loop that counts with it",
    "k, k = 1, 2": "k is bound twice at once",
}
RIGHT = [
    "q = 0.5 * q",
    "q = q[::-1]",
    "for k in range(3):\n    pass\nfor k in range(4):\n    pass",
    "for k in range(3):\n    j = k\n    j += 1",
    "_, _ = 1, 2\nfor _ in range(3):\n    for _ in range(2):\n        pass",
    "def inner(a):\n    q = 0\n    return q",
]


def compiled(body, decorator="@njit(cache=True)"):
    return f"{decorator}\ndef kernel(q, p):\n{indent(dedent(body), '    ')}\n    return q[0]\n"


@pytest.mark.parametrize(("body", "text"), WRONG.items())
@pytest.mark.parametrize("decorator", ["@njit(cache=True)", "@numba.njit", "@register_jitable"])
def test_a_name_that_stands_for_two_things_is_found(body, text, decorator):
    (found,) = findings(compiled(body, decorator))
    assert text in found[1]
    assert findings(compiled(body, "@cache")) == []


@pytest.mark.parametrize("body", RIGHT)
def test_a_value_that_changes_is_none(body):
    assert findings(compiled(body)) == []


def test_the_package_has_none(capsys):
    assert main() == 0
    assert "no name" in capsys.readouterr().out
