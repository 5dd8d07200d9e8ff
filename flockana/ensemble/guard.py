"""Check that worker processes can be started without running the user's script again."""

import ast
import inspect
import pickle
import sys
import warnings
from pathlib import Path
from types import FrameType
from typing import Any

GUARD = 'if __name__ == "__main__":'


def can_start_processes(request: Any) -> bool:
    """Return whether processes can make the runs; warn and return False if this process must."""
    # A started process imports the script that called. Without a guard that would run it again.
    if (line := unguarded_line()) is not None:
        _warn(f"line {line} of the script is not under `{GUARD}`, so the runs are made in this process, one by one")
        return False
    try:
        pickle.dumps(request)
    except Exception as error:  # pickle raises errors of many kinds
        _warn(f"the runs are made in this process, one by one: the flock cannot be sent to another ({error})")
        return False
    return True


def unguarded_line() -> int | None:
    """Return the line of the running script that called, if it is not under a guard."""
    frame: FrameType | None = inspect.currentframe()
    while frame is not None:
        if frame.f_code.co_name == "<module>" and frame.f_globals.get("__name__") in ("__main__", "__mp_main__"):
            break
        frame = frame.f_back
    path = None if frame is None else Path(frame.f_code.co_filename)
    if frame is None or path is None or not hasattr(sys.modules["__main__"], "__file__") or not path.is_file():
        return None  # a notebook or a prompt, which no process imports
    return None if is_guarded(path.read_text(encoding="utf-8"), frame.f_lineno) else frame.f_lineno


def is_guarded(source: str, line: int) -> bool:
    r"""Return whether a line lies under an ``if`` that asks for ``__name__``."""
    return any(
        isinstance(node, ast.If)
        and node.lineno <= line <= (node.end_lineno or node.lineno)
        and any(isinstance(part, ast.Name) and part.id == "__name__" for part in ast.walk(node.test))
        for node in ast.parse(source).body
    )


def _warn(text: str) -> None:
    warnings.warn(f"ensemble: {text}", stacklevel=4)
