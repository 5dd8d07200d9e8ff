"""Check that worker processes can be started without running the user's script again."""

import ast
import pickle
import sys
import warnings
from pathlib import Path
from traceback import walk_stack
from typing import Any

from flockana.ensemble.runs import SENDABLE


def can_start_processes(request: Any) -> bool:
    """Return whether worker processes can make the runs; otherwise warn and return False."""
    # A started process imports the script that called. Without a guard that would run it again.
    reason = ""
    if (line := unguarded_line()) is not None:
        reason = f'line {line} of the script is not under `if __name__ == "__main__":`'
    try:
        pickle.dumps(request)
    except Exception as error:  # pickle raises errors of many kinds
        reason = reason or f"the flock cannot be sent to another ({error}); {SENDABLE}"
    if reason:
        warnings.warn(f"ensemble: the runs are made in this process, one by one: {reason}", stacklevel=3)
    return not reason


def unguarded_line() -> int | None:
    """Return the script's line that called flockana, unless a test of `__name__` guards it."""
    for frame, line in walk_stack(None):
        if frame.f_code.co_name == "<module>" and frame.f_globals.get("__name__") in ("__main__", "__mp_main__"):
            path = Path(frame.f_code.co_filename)
            if not hasattr(sys.modules["__main__"], "__file__") or not path.is_file():
                return None  # a notebook or a prompt, which no process imports
            return None if is_guarded(path.read_text(encoding="utf-8"), line) else line
    return None


def is_guarded(source: str, line: int) -> bool:
    r"""Return whether a line lies under an ``if`` that tests ``__name__``."""
    return any(
        isinstance(node, ast.If)
        and node.lineno <= line <= (node.end_lineno or node.lineno)
        and any(isinstance(part, ast.Name) and part.id == "__name__" for part in ast.walk(node.test))
        for node in ast.parse(source).body
    )
