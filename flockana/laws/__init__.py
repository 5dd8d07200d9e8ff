"""Laws of motion: `law.py` says what a law is; each family is one file."""
