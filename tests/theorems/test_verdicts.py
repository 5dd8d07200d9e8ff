"""All verdicts on a run as a table of claims: pandas and MATLAB."""

import numpy as np
from scipy.io import loadmat

import flockana as fl


def test_the_table_has_a_row_for_each_claim_in_pandas_and_matlab(tmp_path):
    verdicts = fl.verify(law=fl.Algorithm1(), q0=[[0.0], [8.0]], t_span=(0.0, 1.0))
    table = verdicts.to_dataframe()
    claims = [(v.theorem, c) for v in verdicts for c in v.claims]
    assert list(zip(table["theorem"], table["claim"], strict=True)) == [(name, c.name) for name, c in claims]
    assert table["status"].tolist() == [c.status for _, c in claims]
    margins = np.array([np.nan if c.margin is None else c.margin for _, c in claims])
    np.testing.assert_array_equal(table["margin"], margins)
    read = loadmat(verdicts.to_mat(tmp_path / "verdicts.mat"), simplify_cells=True)["claims"]
    assert read["status"].tolist() == table["status"].tolist()
    np.testing.assert_array_equal(read["margin"], margins)
