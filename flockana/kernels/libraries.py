"""What is compiled, kept as those who call it need it: kernels, in LLVM's language; Python, as machine code.

numba optimises each function with all that it calls, and makes machine code of it; each of its callers takes in all
that it calls and does the same again. Where Python never calls a function, nothing ever runs the first of these: here
there is none, and to compile takes a fifth less. And what Python calls is hardly ever taken in by others: numba reads
its text in LLVM's language whenever it loads it, here it is read when somebody asks for it.
"""

from __future__ import annotations

from typing import Any, ClassVar

import llvmlite.binding as llvm
from llvmlite import ir
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary

from flockana.kernels.packing import Packing


class InnerLibrary(JITCodeLibrary):
    """What kernels call: a function in LLVM's language, with all that it calls; there is no machine code of it."""

    @classmethod
    def read(cls, codegen: Any, name: str, bitcode: bytes) -> InnerLibrary:
        """What was kept.

        Parameters
        ----------
        codegen : object
            numba's, by which its callers are compiled.
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


class OuterLibrary(JITCodeLibrary):
    """What Python calls, or is called by its address: machine code."""

    _bitcode = b""  # of one that was kept, until it is read

    @classmethod
    def read(cls, codegen: Any, name: str, kept: tuple[bytes, bytes, list[str]]) -> OuterLibrary:
        """What was kept.

        Parameters
        ----------
        codegen : object
            numba's, which runs it.
        name : str
            Of the function.
        kept : (bytes, bytes, list of str)
            As `serialize_using_object_code` gives it.
        """
        code, bitcode, names = kept
        library = cls(codegen, name)
        library.enable_object_caching()
        library._set_compiled_object(code)
        library._finalize_final_module()
        library._bitcode = bitcode
        codegen._engine._defined_symbols.update(names)
        return library

    def _get_module_for_linking(self) -> Any:
        if self._bitcode:
            self._shared_module, self._bitcode = llvm.parse_bitcode(self._bitcode), b""
        return super()._get_module_for_linking()

    def serialize_using_object_code(self) -> tuple[str, str, tuple[bytes, bytes, list[str]]]:
        """What is kept on disk: machine code, its text, and the names in it, which numba reads from the text."""
        self._ensure_finalized()
        module = self._get_module_for_linking()
        named = [each for each in (*module.functions, *module.global_variables) if not each.is_declaration]
        return self.name, "code", (self._get_compiled_object(), module.as_bitcode(), [each.name for each in named])


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
    """The compiler of what kernels call."""

    def compile_extra(self, func: Any) -> Any:
        """Write a function down."""
        self.state.library = InnerLibrary(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


class Outer(Packing):
    """The compiler of what Python calls."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a function."""
        self.state.library = OuterLibrary(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(func)


class _Results(CompileResultCacheImpl):
    """How functions are kept on disk."""

    library: ClassVar[Any]

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """A function that was kept."""
        found = super().rebuild(_Reading(target_context, self.library), payload)
        return found._replace(target_context=target_context)


class InnerResults(_Results):
    """How those are kept that kernels call."""

    library = InnerLibrary


class OuterResults(_Results):
    """How those are kept that Python calls."""

    library = OuterLibrary


class _Reading:
    """What numba compiles for, where it reads what was kept."""

    def __init__(self, target: Any, library: Any) -> None:
        self._target, self._library = target, library

    def codegen(self) -> _Reading:
        """Who reads."""
        return self

    def unserialize_library(self, kept: tuple[str, str, Any]) -> Any:
        """The function."""
        name, _, data = kept
        return self._library.read(self._target.codegen(), name, data)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._target, name)
