"""Figures: each function draws its data on given or new Axes, and returns them."""

from collections import deque

from flockana.base.lazy_imports import attach_stub
from flockana.base.module_discovery import source_modules

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)

# All of the sources' at once: they may register how the world of a law is drawn (`snapshot.draw_sample`).
deque(source_modules("plots"), maxlen=0)
