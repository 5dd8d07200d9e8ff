"""numba's compiler, rid of what takes time, about a quarter of it, and changes nothing in what it makes.

- Each call that is typed is looked up by the flags of its caller too. numba lists some forty of them, by name, for each
  look and for each comparison.
- What is compiled stays while it is compiled, so there is little garbage to find. Python looks for it after some
  hundreds of new objects, and through all that were ever imported.
"""

from __future__ import annotations

from typing import Any

from numba.core import compiler
from numba.core.compiler_lock import global_compiler_lock

from flockana.base.garbage import relaxed_gc

_DEFAULTS = {name: option.default for name, option in compiler.Flags.options.items()}


class Flags(compiler.Flags):
    """numba's flags, which are listed at once."""

    __slots__ = ()

    def values(self) -> dict[str, Any]:
        """All of them, by name."""
        return {**_DEFAULTS, **self._values}


class Compiler(compiler.Compiler):
    """numba's compiler, with such flags; of several threads one compiles, and garbage is seldom sought meanwhile."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a function."""
        self.state.flags = Flags(self.state.flags)
        with global_compiler_lock, relaxed_gc():
            return super().compile_extra(func)
