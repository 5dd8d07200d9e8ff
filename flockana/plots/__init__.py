"""Figures: each function draws what it is given on an Axes, or on a new one, and returns it; it computes nothing."""

import pkgutil
from importlib import import_module

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

# All of them at once: a file here may register how the world of a law is drawn (`snapshot.draw_sample`).
for _module in pkgutil.iter_modules(__path__, f"{__name__}."):
    import_module(_module.name)
