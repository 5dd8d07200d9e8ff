"""Lecture slides on Olfati-Saber's algorithms (Geschwender 2016): errata E1 to E14."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
