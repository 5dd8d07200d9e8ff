"""Figures: each function draws what it is given on an Axes, or on a new one, and returns it; it computes nothing."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

import flockana.plots.zones  # noqa: E402  # how the world of a zone-based law is drawn is registered there
