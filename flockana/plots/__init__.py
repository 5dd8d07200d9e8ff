"""Figures: each function draws its data on given or new Axes, and returns them."""

from collections import deque

import lazy_loader

from flockana.base.modules import modules

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

# All of them at once: a file here may register how the world of a law is drawn (`snapshot.draw_sample`).
deque(modules(__name__), maxlen=0)
