"""numba's compiler, which packs numbers that lie side by side into one vector: an agent's place is two or three.

LLVM calls it superword-level parallelism. Each operation stays what it is, of the same two numbers, so results keep
their bits. numba has it for a whole process or not at all, and where a scalar function was packed the loop around it is
not vectorised any more: here it is for kernels, when all that they call has been compiled, and not for what is inlined
into them.
"""

from __future__ import annotations

from typing import Any

from numba import config
from numba.core.compiler import DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering

from flockana.kernels.compiler import Compiler


@register_pass(mutates_CFG=True, analysis_only=False)
class PackedLowering(NativeLowering):
    """To machine code, with packing; numba holds its lock meanwhile."""

    _name = "packed_native_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower a function."""
        before, config.SLP_VECTORIZE = config.SLP_VECTORIZE, 1
        try:
            lowered: bool = super().run_pass(state)
        finally:
            config.SLP_VECTORIZE = before
        return lowered


class Packing(Compiler):
    """The compiler, whose last step is that."""

    def define_pipelines(self) -> list[Any]:
        """Its steps."""
        steps = DefaultPassBuilder.define_nopython_pipeline(self.state)
        steps.passes[:] = [(PackedLowering if each is NativeLowering else each, why) for each, why in steps.passes]
        steps.finalize()
        return [steps]
