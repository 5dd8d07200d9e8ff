"""Taylor steps: q + p dt + ½ u dt², p + u dt, with u at the beginning of the step."""

from flockana.solvers.fixed_steps import FixedStep


class TaylorStep(FixedStep):
    """Taylor steps q' = q + dt p + ½ dt² u(t, q, p), p' = p + dt u, exact for constant input.

    The R² notebook's iteration, and the plainest reading of a source that prints a step and no method. It is of order
    1: the input is not looked at again within the step, so that fast vibrations are fed with energy.

    Examples
    --------
    A constant input is stepped exactly:

    >>> import numpy as np
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> law = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((2.0,)))
    >>> q, p, u, _ = TaylorStep(law, 0.5).step(0.0, np.zeros((1, 1)), np.zeros((1, 1)), {})
    >>> float(q[0, 0]), float(p[0, 0]), float(u[0, 0])
    (0.25, 1.0, 2.0)
    """

    order = 1
    position_factor = 0.5
