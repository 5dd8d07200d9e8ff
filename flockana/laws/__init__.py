"""Laws of motion: the base class in `law.py`, and one file for each family."""
