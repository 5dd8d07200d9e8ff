"""The Euler-Maruyama method."""

from flockana.solvers.taylor_step import TaylorStep


class EulerMaruyama(TaylorStep):
    """Taylor steps with white noise: q' = q + h p + ½ h² u, p' = p + h u + Δw, exact where the input is held."""

    takes_noise = True
    order_of_wrapped = 1

    @property
    def name(self) -> str:
        """Name by which `simulate(..., method=)` knows it."""
        return "Euler-Maruyama"
