"""Claims of the user's own over many seeds: in this process, in others, in a store, and what is refused."""

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.ensemble import shares
from tests.ensemble import tiny_flocks

SLOW = fl.claim("slow", tiny_flocks.slowness)


def test_a_claim_of_ones_own_is_checked_on_every_seed(tmp_path):
    runs = fl.ensemble(tiny_flocks.trio, range(4), theorems=[SLOW, "energy"], jobs=1, store=tmp_path / "runs.sqlite")
    direct = [fl.verify(SLOW, tiny_flocks.trio(seed).run()).claim("slow") for seed in range(4)]
    table = runs.sel(claim="slow:slow")
    np.testing.assert_allclose(table["margin"].values, [claim.margin for claim in direct], rtol=1e-12)
    assert float(shares(runs).sel(claim="slow:slow", of="verified").share) == np.mean(
        [claim.status == "verified" for claim in direct]
    )
    again = fl.ensemble(tiny_flocks.trio, range(4), theorems=[SLOW, "energy"], jobs=1, store=tmp_path / "runs.sqlite")
    assert again.identical(runs)  # seconds included: nothing was computed anew


@pytest.mark.slow
def test_a_claim_at_the_top_of_a_module_goes_to_other_processes():
    with_two = fl.ensemble(tiny_flocks.trio, range(4), theorems=[SLOW], jobs=2)
    alone = fl.ensemble(tiny_flocks.trio, range(4), theorems=[SLOW], jobs=1)
    assert with_two.drop_vars("seconds").identical(alone.drop_vars("seconds"))


def test_a_lambda_is_computed_here_with_a_word_why():
    here = fl.claim("here", lambda run: 1.0)
    with pytest.warns(UserWarning, match="the runs are made in this process, one by one: the flock cannot be sent"):
        runs = fl.ensemble(tiny_flocks.trio, range(3), theorems=[here], jobs=2)
    assert float(shares(runs).sel(claim="here:here", of="verified").share) == 1.0


@pytest.mark.parametrize(
    ("theorems", "message"),
    [
        ([fl.claim("energy", lambda run: 1.0)], "your claim 'energy' has the name of one in the catalogue; rename it"),
        ([3], "theorems: 3: expected names of theorems, or claims of your own"),
        (SLOW, "expected several, such as"),
        (["E1"], "E1 is not about a run"),
    ],
)
def test_what_is_no_list_of_theorems_is_refused(theorems, message):
    with pytest.raises(ArgumentError, match=message):
        fl.ensemble(tiny_flocks.trio, range(2), theorems=theorems, jobs=1)
