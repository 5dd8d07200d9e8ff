"""Reynolds' rules inside Algorithm 1: flock centring, collision avoidance, velocity matching.

The force between neighbours is a spring along the link, s_ij (q_j − q_i), of stress
s_ij = φ_α(‖q_j − q_i‖_σ)/(1 + ε‖q_j − q_i‖_σ). Its sign parts the neighbours of an agent into positive friends F⁺
(too far: centring), negative friends F⁻ (too close: avoidance) and neutral ones F⁰.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray, ensure_index, ensure_state
from flockana.interactions import AlphaInteraction, Gains
from flockana.kernels.neighbours import pair_list

IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Reynolds:
    """Input of Algorithm 1 split into Reynolds' rules.

    Attributes
    ----------
    links : ndarray, shape (M, 2)
        Neighbours (i, j), each pair once.
    stress : ndarray, shape (M,)
        s_ij of each link; s_ij = s_ji.
    adjacency : ndarray, shape (M,)
        a_ij of each link.
    centring : ndarray, shape (n, m)
        c1α Σ over F⁺ of s_ij (q_j − q_i).
    avoidance : ndarray, shape (n, m)
        c1α Σ over F⁻ of s_ij (q_j − q_i).
    matching : ndarray, shape (n, m)
        c2α Σ_j a_ij (p_j − p_i).
    """

    links: IndexArray
    stress: FloatArray
    adjacency: FloatArray
    centring: FloatArray
    avoidance: FloatArray
    matching: FloatArray

    @property
    def total(self) -> FloatArray:
        """Sum of the three rules, the input u of Algorithm 1, shape (n, m)."""
        return self.centring + self.avoidance + self.matching

    def friends(self, agent: int) -> tuple[IndexArray, IndexArray, IndexArray]:
        """Return (F⁺, F⁻, F⁰): the positive, negative and neutral friends of an agent, in rising order.

        Parameters
        ----------
        agent : int
            Its number, 0 to n − 1.
        """
        agent = ensure_index("agent =", agent, len(self.centring))
        of_agent = (self.links == agent).any(axis=1)
        neighbours, stress = self.links[of_agent].sum(axis=1) - agent, self.stress[of_agent]
        plus, minus, neutral = (np.sort(neighbours[sign]) for sign in (stress > 0.0, stress < 0.0, stress == 0.0))
        return plus, minus, neutral

    def counts(self) -> IndexArray:
        """Return the numbers of positive, negative and neutral friends of every agent, shape (n, 3)."""
        n = len(self.centring)
        signs = (self.stress > 0.0, self.stress < 0.0, self.stress == 0.0)
        columns = [np.bincount(self.links[sign].ravel(), minlength=n) for sign in signs]
        return np.column_stack(columns).astype(np.int64)


def reynolds(q: Any, p: Any, *, alpha: AlphaInteraction | None = None, gains: Gains | None = None) -> Reynolds:
    """Return the input of Algorithm 1 split into Reynolds' three rules (Olfati-Saber 2006).

    Parameters
    ----------
    gains : Gains, optional
        c1_alpha and c2_alpha are used.

    Examples
    --------
    In a row with gaps of 5 and 8 at d = 7 the middle agent has a negative and a positive friend:

    >>> rules = reynolds([[0.0], [5.0], [13.0]], [[0.0], [0.0], [0.0]])
    >>> [friends.tolist() for friends in rules.friends(1)]
    [[2], [0], []]
    >>> bool(rules.avoidance[1, 0] > 0.0), bool(rules.centring[1, 0] > 0.0)
    (True, True)
    """
    q, p = ensure_state(q, p)
    alpha, gains = alpha or AlphaInteraction(), gains or Gains()
    i, j = pair_list(q, alpha.r)
    z = alpha.sigma_norm(np.linalg.norm(q[j] - q[i], axis=1))
    stress, adjacency = alpha.phi_alpha(z) / (1.0 + alpha.eps * z), alpha.adjacency(z)

    def pushed(weight: FloatArray, x: FloatArray) -> FloatArray:
        force = weight[:, None] * (x[j] - x[i])
        total = np.zeros_like(x)
        np.add.at(total, i, force)
        np.add.at(total, j, -force)
        return total

    return Reynolds(
        np.column_stack([i, j]).astype(np.int64),
        stress,
        adjacency,
        gains.c1_alpha * pushed(np.maximum(stress, 0.0), q),
        gains.c1_alpha * pushed(np.minimum(stress, 0.0), q),
        gains.c2_alpha * pushed(adjacency, p),
    )
