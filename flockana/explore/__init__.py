"""Local interactive page for choosing, dragging and changing a flock.

A small server of our own on tornado, whose page holds the player: Panel and marimo keep the state of a page in Python
widgets, and neither takes a drag on the player's canvas, sends frames of a run under way, or breaks it off.
"""
