import base64
import json

import numpy as np

from flockana import Algorithm1, linearise
from flockana.report.control_figures import state_space


def test_the_state_space_is_the_linearisation():
    flock = linearise(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]])
    file = state_space(flock, "pair.json", "two agents")
    head, text = file.address.split(",")
    data = json.loads(base64.b64decode(text))
    a = np.zeros(data["A_shape"])
    for i, j, value in data["A_row_column_value"]:
        a[i, j] = value
    np.testing.assert_array_equal(a, flock.A)
    assert (head, file.name, data["what"]) == ("data:application/json;base64", "pair.json", "two agents")
