"""Three agents under Algorithm 2 to twenty-five digits, by mpmath and extrapolation, against every adaptive method.

Nothing here is the library's: the law is written out once more, and integrated by the method of Gragg, Bulirsch and
Stoer. All pairs stay on the taper, where the law is analytic.
"""

from functools import cache

import mpmath as mp
import numpy as np
import pytest

import flockana as fl

Q0 = [[-3.6, -2.1], [3.4, -1.9], [0.2, 4.1]]
P0 = [[0.5, -0.3], [-0.4, 0.2], [0.1, 0.6]]
LAW = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
END, COLUMNS = 0.25, 14  # of the extrapolation: order 28


def pair(s2):
    """(weight of q_j - q_i, a_ij): ρ_h(z/r_α) φ(z - d_α)/√(1 + ε s²) with a = b, and ρ_h."""
    eps, h, d, r, a = (mp.mpf(getattr(LAW.alpha, name)) for name in ("eps", "h", "d", "r", "a"))
    norm = lambda square: (mp.sqrt(1 + eps * square) - 1) / eps  # noqa: E731
    z = norm(s2)
    rho = (1 + mp.cospi((z / norm(r * r) - h) / (1 - h))) / 2
    s = z - norm(d * d)
    return rho * a * s / mp.sqrt(1 + s * s) / mp.sqrt(1 + eps * s2), rho


def field(state):
    c1, c2, pull, drag = (mp.mpf(getattr(LAW.gains, f"{c}_{of}")) for of in ("alpha", "gamma") for c in ("c1", "c2"))
    q, p = (np.array(half, dtype=object).reshape(3, 2) for half in (state[:6], state[6:]))
    u = -pull * q - drag * p
    for i, j in ((0, 1), (0, 2), (1, 2)):
        gap, slip = q[j] - q[i], p[j] - p[i]
        weight, adjacency = pair(gap.dot(gap))
        force = c1 * weight * gap + c2 * adjacency * slip
        u[i], u[j] = u[i] + force, u[j] - force
    return np.concatenate([p.ravel(), u.ravel()])


def extrapolated(state, step):
    """One step of Gragg's modified midpoint rule in 2, 4, 6, ... parts, extrapolated to none."""
    table = []
    for k in range(1, COLUMNS + 1):
        parts = 2 * k
        h = step / parts
        before, now = state, state + h * field(state)
        for _ in range(1, parts):
            before, now = now, before + 2 * h * field(now)
        row = [(before + now + h * field(now)) / 2]
        for m in range(1, k):
            finer = row[m - 1]
            row.append(finer + (finer - table[-1][m - 1]) / ((mp.mpf(k) / (k - m)) ** 2 - 1))
        table.append(row)
    return table[-1][-1]


@cache
def solution(steps):
    with mp.workdps(40):
        state = np.array([mp.mpf(x) for x in (*np.ravel(Q0), *np.ravel(P0))], dtype=object)
        for _ in range(steps):
            state = extrapolated(state, mp.mpf(END) / steps)
        return state


@pytest.mark.slow
def test_the_reference_is_known_to_twenty_five_digits():
    with mp.workdps(40):
        assert max(abs(a - b) for a, b in zip(solution(8), solution(12), strict=True)) < mp.mpf("1e-25")


@pytest.mark.slow
@pytest.mark.parametrize("method", ["DOP853", "scipy-DOP853", "RK45", "scipy-RK45", "LSODA"])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_every_method_comes_to_it(method, rtol):
    """Within ten times its tolerance, of lengths of about 5, and the rounding of as many steps."""
    run = fl.simulate(LAW, Q0, P0, (0.0, END), method=method, rtol=rtol, atol=1e-2 * rtol)
    found = np.concatenate([run.q[-1].ravel(), run.p[-1].ravel()])
    error = max(abs(float(mp.mpf(x) - y)) for x, y in zip(found.tolist(), solution(12), strict=True))
    assert error < 10.0 * rtol * 5.0 + 1e-13
    assert np.abs(run.energy_residual).max() < 10.0 * rtol * run.energy()[0]


@pytest.mark.slow
def test_fixed_steps_come_to_it_with_their_order():
    errors = []
    for dt in (0.01, 0.005):
        run = fl.simulate(LAW, Q0, P0, (0.0, END), method="RK4", dt=dt)
        found = np.concatenate([run.q[-1].ravel(), run.p[-1].ravel()])
        errors.append(max(abs(float(mp.mpf(x) - y)) for x, y in zip(found.tolist(), solution(12), strict=True)))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.25)


def test_all_pairs_stay_where_the_law_is_analytic():
    run = fl.simulate(LAW, Q0, P0, (0.0, END))
    i, j = np.triu_indices(3, 1)
    z = LAW.alpha.sigma_norm(np.linalg.norm(run.q[:, i] - run.q[:, j], axis=2))
    assert LAW.alpha.h * LAW.alpha.r_alpha < 0.9 * z.min()
    assert z.max() < 0.9 * LAW.alpha.r_alpha
