"""numba's compiler for what kernels alone call: written down in LLVM's language, for its callers to take in.

numba optimises each function with all that it calls, and makes machine code of it; each of its callers takes in all
that it calls and does the same again. Where Python never calls a function, nothing ever runs the first of these: here
there is none. To compile takes a fifth less.
"""

from __future__ import annotations

from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary

from flockana.kernels.packing import Packing


class InnerLibrary(JITCodeLibrary):
    """A function in LLVM's language, and all that it calls; there is no machine code of it."""

    @classmethod
    def read(cls, codegen: Any, name: str, bitcode: bytes) -> InnerLibrary:
        """What was written before.

        Parameters
        ----------
        codegen : object
            numba's, which its callers are compiled by.
        name : str
            Of the function.
        bitcode : bytes
            As `serialize_using_object_code` gives it.
        """
        library = cls(codegen, name)
        library._final_module = llvm.parse_bitcode(bitcode)
        library._finalize_final_module()
        return library

    def _optimize_final_module(self) -> None:
        """Its callers will."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Null, as of all that is not there."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> Any:
        """numba's, to which the name of an environment may be new."""
        return _Naming(self._codegen)

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """What is kept on disk: no object code, as there is none."""
        self._ensure_finalized()
        return self.name, "bitcode", self._get_module_for_linking().as_bitcode()


class _Naming:
    """What generates code, where a function that has none gets its environment: its callers look it up by name."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, name: str, environment: Any) -> None:
        """Set it, by that name."""
        if not self._codegen._engine.is_symbol_defined(name):
            named = ir.Module(name)
            place = ir.GlobalVariable(named, pointer := ir.IntType(8).as_pointer(), name)
            place.linkage, place.initializer = "common", pointer(None)
            self._codegen._add_module(llvm.parse_assembly(str(named)))
        self._codegen.set_env(name, environment)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class Inner(Packing):
    """The compiler of such functions."""

    def compile_extra(self, func: Any) -> Any:
        """Write a function down."""
        self.state.library = InnerLibrary(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


class InnerResults(CompileResultCacheImpl):
    """How such functions are kept on disk."""

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """A function that was written down before."""
        found = super().rebuild(_Reading(target_context), payload)
        return found._replace(target_context=target_context)


class _Reading:
    """What numba compiles for, where it reads what was kept."""

    def __init__(self, target: Any) -> None:
        self._target = target

    def codegen(self) -> _Reading:
        """Who reads."""
        return self

    def unserialize_library(self, kept: tuple[str, str, bytes]) -> InnerLibrary:
        """The function, as it was written down."""
        name, _, bitcode = kept
        return InnerLibrary.read(self._target.codegen(), name, bitcode)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._target, name)
