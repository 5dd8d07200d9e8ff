"""Interface of the terms of a law: force, power, share of the energy, and derivatives."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import LawFunction
from flockana.jit import Kernel
from flockana.kernels.cell_grid import LARGE, empty_cuts
from flockana.kernels.large_flocks import work_of
from flockana.kernels.law_kernels import LawFunctions, LawNumbers, law_functions, law_numbers
from flockana.kernels.listed_pairs import Listed
from flockana.kernels.pair_helpers import BLOCK
from flockana.kernels.runge_kutta import System
from flockana.kernels.verlet_list import SKIN
from flockana.laws.law_features import Feature, Unknown, function_feature

_NO_PAIRS = np.zeros(2, np.int64)  # where those of the only slab begin and end
Derivatives = tuple[Any, Any]  # (∂u/∂q, ∂u/∂p), sparse or as blocks
Invariance = Literal["rigid motions", "rotations about the target", "none"]


class TermKernel(NamedTuple):
    """Term in the form of compiled integrators (`flockana.kernels.law_kernels`).

    Attributes
    ----------
    act, energy : Kernel
        Force and power, and potential energy.
    numbers : ndarray, shape (K,)
        What they read.
    panels : ndarray, shape (L, M)
        Chebyshev panels, if they read any.
    reach : float
        Within which they need all pairs; 0 if they need none.
    numbered : bool
        Whether they name agents by their numbers, so that agents must not be sorted.
    """

    act: Kernel
    energy: Kernel
    numbers: FloatArray
    panels: FloatArray
    reach: float
    numbered: bool = False

    def on_agents(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:
        """Run the kernel `act` of a term without pairs, in a frame at rest.

        Parameters
        ----------
        u : ndarray, shape (n, m)
            Accelerations, to which those of the term are added.
        """
        (n, m), none = q.shape, np.empty(0, np.uint32)
        order, workspace = np.arange(n, dtype=np.uint64), np.empty((2, 0), np.uint64)
        pair_storage = Listed(np.zeros((2, m)), none, none, 0, _NO_PAIRS, order, workspace, np.empty((3, m)))
        x, v = np.ascontiguousarray(q), np.ascontiguousarray(p)
        return float(self.act(t, x, v, u, self.numbers, self.panels, pair_storage))


class Compiled(NamedTuple):
    """Law in the form of compiled integrators: its terms, and whether its energy is in the moving frame."""

    terms: tuple[TermKernel, ...]
    moving: bool

    @property
    def reach(self) -> float:
        """Largest distance within which any term of the compiled law needs all pairs of agents."""
        return max((term.reach for term in self.terms), default=0.0)

    def functions(self, *, several: bool = False) -> LawFunctions:
        """Return the compiled force and energy functions of the law.

        Parameters
        ----------
        several : bool
            Whether they are for several threads.
        """
        return law_functions(tuple((term.act, term.energy) for term in self.terms), several)

    @property
    def numbers(self) -> LawNumbers:
        """Numeric parameters of the law's compiled force and energy functions."""
        return law_numbers(self.terms)

    def system(self, view: tuple[float, FloatArray, FloatArray], n: int, m: int) -> System:
        """Return the law's data for compiled integration steps, with agents in their original order.

        Parameters
        ----------
        view
            The frame (start, origin, drift) that forces are seen from.
        """
        reach, agents = (self.reach, SKIN * self.reach), np.arange(n, dtype=np.uint64)
        slabs = empty_cuts(n).size - 2
        workspace = np.empty((2, m)), np.empty((2 * slabs, BLOCK), np.uint64), np.empty((3 * slabs, BLOCK))
        return System(
            *self.functions(), self.numbers, view, self.moving, reach, work_of(large=n >= LARGE), agents, *workspace
        )

    def in_threads(self, system: System) -> System:
        """Return the compiled system with force and energy functions that run in several threads.

        Parameters
        ----------
        system : System
            The law for one thread.
        """
        force, energy = self.functions(several=True)
        return system._replace(force=force, energy=energy, work=work_of(large=True, several=True))


class Term(ShortRepr, ABC):
    """Term u^T of a law u = Σ u^T; results are unchecked, as the law checks the sum once.

    A derivative is either a sparse matrix (n m, n m) in the order of ``q.ravel()``, or an array of blocks (n, m, m),
    where an agent feels of the others nothing.
    """

    conservative: ClassVar[bool] = True
    """Whether the force at rest is minus the gradient of `energy`."""

    idle: ClassVar[bool] = False
    """Whether it pushes nobody at rest and has no energy, wherever the agents are: equilibria do without it."""

    @property
    def invariance(self) -> Invariance:
        """Motions that leave the term's energy unchanged; by default rigid motions."""
        return "rigid motions"

    @property
    def centre_decouples(self) -> bool:
        """Whether shape and centre of mass decouple: the term's forces cancel, or are one linear pull or drag."""
        return self.invariance == "rigid motions"

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Functions of the distance of two agents in the term; () for none."""
        return Unknown(type(self).__name__).functions

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest features of the term's parts; by default of its functions of distance."""
        return tuple(map(function_feature, self.functions))

    @property
    def moving(self) -> bool:
        """Whether the term's energy and power are measured in the frame of the flock's centre of mass."""
        return False

    @abstractmethod
    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:
        """Add the term's force to u in place, and return its contribution to the energy rate dH/dt.

        Parameters
        ----------
        u : ndarray, shape (n, m)
            Accelerations to add to.
        """

    def energy(self, t: float, q: FloatArray) -> float:
        """Return the term's potential energy; 0 if it has none."""
        return 0.0

    @abstractmethod
    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:
        """Return (∂u/∂q, ∂u/∂p) of the term's force."""

    def hessian(self, t: float, q: FloatArray) -> Any:
        """Return the second derivative of `energy` by positions; 0 unless a term has one."""
        return np.zeros((*q.shape, q.shape[1]))

    def compiled(self, m: int) -> TermKernel | tuple[TermKernel, ...] | None:
        """Return the term in compiled form, or several compiled terms whose sum it is; None without one.

        None, and the law is stepped by scipy's, unless it has one.
        """
        return None

    def check_dimension(self, m: int) -> None:  # nothing to check unless a term says so
        """Raise if the term is not defined in m dimensions."""

    def check_agents(self, n: int) -> None:  # as `check_dimension`
        """Raise if the term is not for n agents."""

    def check_start(self, q: FloatArray) -> None:  # as `check_dimension`
        """Raise if the term forbids a start from the given positions."""
