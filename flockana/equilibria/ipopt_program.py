"""Nonlinear program for IPOPT: the potential of a law over a list of pairs, with its gradient and Hessian.

All three come from the law's kernels, by CasADi callbacks that nothing differentiates: ψ_α on its taper is no
elementary function.

CasADi loses Ctrl-C, or takes it for a failed evaluation: so it is held wherever CasADi is at work.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
import numpy.typing as npt

from flockana.base.interrupts import defer_sigint
from flockana.base.value_checks import FloatArray
from flockana.equilibria.potential import Potential, inside_obstacle
from flockana.measures.nets import LinkArray

# the box is there to keep steps short, and is seldom active at the end: a barrier of almost nothing
_BOX = {
    "ipopt.nlp_scaling_method": "none",
    "ipopt.mu_init": 1e-6,
    "ipopt.bound_push": 1e-8,
    "ipopt.bound_frac": 1e-8,
    "ipopt.bound_relax_factor": 0.0,
}
_QUIET = {"print_time": False, "no_nlp_grad": True, "calc_lam_p": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
_TOL = 1e-10


class _Callback(ca.Callback):
    """Base class of CasADi functions of the nonlinear program's unknown vector x, evaluated by kernels."""

    def __init__(self, name: str, program: Program) -> None:
        ca.Callback.__init__(self)
        self._program = program
        self.construct(name, {})

    def get_sparsity_in(self, _: int) -> Any:
        return ca.Sparsity.dense(self._program.size, 1)


class _Value(_Callback):
    """CasADi function that evaluates the potential energy in the nonlinear program's units."""

    def eval(self, arguments: Any) -> list[float]:
        return [self._program.value(np.asarray(arguments[0]).ravel())]


class _Derivatives(_Callback):
    """CasADi function that evaluates the potential's gradient and the upper triangle of its Hessian."""

    def __init__(self, program: Program) -> None:
        self._at = _upper_triangle(program.shape, program.pairs)
        self._pattern = ca.Sparsity.triplet(program.size, program.size, *(item.tolist() for item in self._at))
        super().__init__("derivatives", program)

    def get_n_out(self) -> int:
        return 2

    def get_sparsity_out(self, index: int) -> Any:
        return self._pattern if index else ca.Sparsity.dense(self._program.size, 1)

    def eval(self, arguments: Any) -> list[Any]:
        program = self._program
        q = program.d * np.asarray(arguments[0]).reshape(program.shape)
        slope = -program.potential.force(q).ravel() * (program.d / program.unit)
        entries = np.asarray(program.potential.stiffness(q)[self._at]).ravel() * (program.d**2 / program.unit)
        return [ca.DM(slope), ca.DM(self._pattern, entries)]


class _Watch(ca.Callback):
    """Iteration callback that stops IPOPT on Ctrl-C."""

    def __init__(self, size: int, gauge: int) -> None:
        ca.Callback.__init__(self)
        self._rows = {"x": size, "f": 1, "g": gauge, "lam_x": size, "lam_g": gauge, "lam_p": size * gauge}
        self.came: list[int] = []
        self.construct("watch", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_sparsity_in(self, index: int) -> Any:
        return ca.Sparsity.dense(self._rows[ca.nlpsol_out(index)], 1)

    def eval(self, _: Any) -> list[int]:
        return [len(self.came)]


class Program:
    """Minimise a potential over a fixed list of pairs, rigid motions fixed by linear constraints.

    The unknown is x = q.ravel()/d, the objective the potential over force_scale d: gradients come out in units of the
    force scale. The gauge Cᵀ(x − x⁰) = 0, C a basis of the potential's symmetries at the start, takes the directions
    out in which it is flat by construction; every configuration has a copy that satisfies it, so nothing is lost.
    """

    @defer_sigint()
    def __init__(self, potential: Potential, shape: tuple[int, int], pairs: LinkArray, gauge: int) -> None:
        self.potential, self.shape, self.pairs, self.gauge = potential, shape, pairs, gauge
        self.size = shape[0] * shape[1]
        self.d = potential.pair.length
        self.unit = potential.force_scale * self.d
        x, c = ca.MX.sym("x", self.size), ca.MX.sym("c", self.size * gauge)
        self._value, self.derivatives = (
            _Value("value", self),
            _Derivatives(self),
        )  # kept alive: CasADi holds no reference
        self._watch, (slope, hessian) = _Watch(self.size, gauge), self.derivatives(x)
        value, multiplier, ignored_input = self._value(x), ca.MX.sym("lam_f"), ca.MX.sym("lam_g", gauge)
        fixed_motions = ca.reshape(c, self.size, gauge).T @ x
        self._program: Any = {"x": x, "p": c, "f": value, "g": fixed_motions}
        self._exact = {
            "grad_f": ca.Function("grad_f", [x, c], [value, slope]),
            "hess_lag": ca.Function("hess_lag", [x, c, multiplier, ignored_input], [multiplier * hessian]),
        }
        self._solvers: dict[int, Any] = {}

    def value(self, x: FloatArray) -> float:
        """Return the objective at x; NaN inside an obstacle, so that IPOPT shortens the step."""
        q = self.d * x.reshape(self.shape)
        if inside_obstacle(self.potential.law, q):
            return float("nan")
        return self.potential.listed_energy(q, self.pairs) / self.unit

    def solve(
        self, q0: FloatArray, *, basis: FloatArray | None = None, reach: float = np.inf, max_iter: int = 3000
    ) -> tuple[FloatArray, bool, str]:
        """Minimise the potential from q0; return (positions, whether IPOPT succeeded, IPOPT's status)."""
        start = q0.ravel() / self.d
        basis = self.potential.symmetries(q0) if basis is None else basis
        fixed_motions = basis.T @ start
        box = {"lbx": start - reach / self.d, "ubx": start + reach / self.d}
        with defer_sigint() as self._watch.came:
            solver = self._solver(max_iter)
            solution = solver(x0=start, p=basis.T.ravel(), lbg=fixed_motions, ubg=fixed_motions, **box)
            stats, x = solver.stats(), np.array(solution["x"])
        return self.d * x.reshape(self.shape), bool(stats["success"]), str(stats["return_status"])

    def _solver(self, max_iter: int) -> Any:
        """Return the IPOPT solver of the nonlinear program with a limit of iterations (cached)."""
        if max_iter not in self._solvers:
            limits: Any = {"ipopt.tol": _TOL, "ipopt.max_iter": max_iter, "iteration_callback": self._watch}
            options = _QUIET | _BOX | limits | self._exact
            self._solvers[max_iter] = ca.nlpsol("equilibrium", "ipopt", self._program, options)
        return self._solvers[max_iter]


def _upper_triangle(shape: tuple[int, int], pairs: LinkArray) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return rows and columns of the Hessian's upper triangle, column by column, in CasADi's order."""
    (n, m), (i, j), agents = shape, pairs.T.astype(np.int64), np.arange(shape[0])
    a, b = np.append(np.minimum(i, j), agents)[:, None, None], np.append(np.maximum(i, j), agents)[:, None, None]
    row, column = np.broadcast_arrays(m * a + np.arange(m)[:, None], m * b + np.arange(m))
    entries = np.unique((column * (n * m) + row)[row <= column])
    return entries % (n * m), entries // (n * m)
