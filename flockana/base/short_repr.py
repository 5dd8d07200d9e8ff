"""Short printed form of parameters and results: at most twelve lines, and a table in a notebook."""

import textwrap
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from flockana.base.table_export import facts_html

_WIDTH, _LINES = 120, 12
_FEW, _FIRST = 6, 3  # entries of a sequence that are all written; those that are written of a longer one
_VALUE, _SHORT = 240, 60  # characters of one value; of one among very many


class ShortRepr:
    """Base class of dataclasses with a printed form of at most twelve lines; long values are shortened."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.__repr__ = cls.__repr__  # type: ignore[method-assign]  # its own, which the decorator dataclass leaves

    def __repr__(self) -> str:
        """Return the class name with the fields, on several lines if they are long."""
        if not is_dataclass(self):
            return object.__repr__(self)
        for most in (_VALUE, _SHORT):
            text = (
                f"{type(self).__name__}({', '.join(f'{name}={value}' for name, value in _texts(self, most).items())})"
            )
            lines = textwrap.wrap(text, _WIDTH, subsequent_indent="  ", break_on_hyphens=False)
            if len(lines) <= _LINES:
                break
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        return facts_html(type(self).__name__, _texts(self, _VALUE) if is_dataclass(self) else {})


def _texts(item: Any, most: int) -> dict[str, str]:
    """Return the fields of a dataclass as texts of limited length."""
    return {field.name: short_text(getattr(item, field.name), most) for field in fields(item) if field.repr}


def short_text(value: Any, most: int = _VALUE) -> str:
    """Return a value as text on one line: the first entries of a long sequence, the class of a large object."""
    if isinstance(value, np.ndarray | np.generic):
        text = repr(value.tolist()) if value.size <= _FEW else f"<array of shape {value.shape}>"
    elif isinstance(value, Fraction):
        text = repr(value) if len(repr(value)) <= _SHORT // 2 else f"{float(value):.6g}"
    elif type(value) in (tuple, list):
        parts = [short_text(item, most) for item in (value if len(value) <= _FEW else value[:_FIRST])]
        parts += [f"… {len(value)} in all"] if len(value) > _FEW else []
        text = ", ".join(parts)
        text = f"[{text}]" if isinstance(value, list) else f"({text},)" if len(value) == 1 else f"({text})"
    else:
        text = " ".join(line.strip() for line in repr(value).splitlines())
    if len(text) <= most:
        return text
    return f"{type(value).__name__}(…)" if is_dataclass(value) else f"{text[: most - 1]}…"
