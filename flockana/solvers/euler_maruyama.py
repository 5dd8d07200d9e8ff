"""The Euler-Maruyama method."""

from flockana.solvers.taylor_step import TaylorStep


class EulerMaruyama(TaylorStep):
    """Taylor steps with white noise: q' = q + h p + ½ h² u, p' = p + h u + Δw, exact for constant input."""

    takes_noise = True
    order_of_wrapped = 1

    @property
    def name(self) -> str:
        """Name of the solver for `simulate(..., method=)`."""
        return "Euler-Maruyama"
