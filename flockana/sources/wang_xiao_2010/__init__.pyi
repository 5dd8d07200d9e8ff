from .laws import FiniteTimeAlignment as FiniteTimeAlignment
