"""Modules from templates and generated text, bound to the functions and numbers of one law.

A template is a module of its own, in which a comment marks the lines that may be replaced. A bound module is written to
a file that is named by a digest of its text, so that numba keeps what it compiles of it.
"""

import itertools
import re
import sys
from contextlib import suppress
from functools import cache
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

from flockana.base.digests import sha256
from flockana.base.files import write_atomic
from flockana.jit import Kernel, is_modules_own, kernels_folder, sources_digest, sources_folder

_COUNT, _ONE = itertools.count(), RLock()  # no thread is given a module that another still runs
_BOUND = re.compile(r"^(?:from .+ import \w+ as )?(\w+)(?: = .+)?  # bound$", re.MULTILINE)


@cache
def bound(template: str, **bindings: Any) -> ModuleType:
    """Return the module of a template's source with given functions and constants bound to its names."""
    spec = find_spec(template)
    text = Path(spec.origin).read_text("utf-8")  # type: ignore[union-attr, arg-type]
    functions, left = {}, dict(bindings)

    def line(match: re.Match[str]) -> str:
        name = match[1]
        if name not in left:
            return match[0]
        value = left.pop(name)
        if not isinstance(value, Kernel):
            return f"{name} = {value!r}"
        functions[name] = value
        return f"# {name}"

    text = _BOUND.sub(line, text)
    if left:
        raise TypeError(f"{template} has no line that binds {next(iter(left))}")
    return made(text, template.rpartition(".")[2], **functions)


def made(text: str, name: str, **functions: Kernel) -> ModuleType:
    """Return a module with the given source text and the given functions as its globals."""
    named = {mine: it for mine, it in functions.items() if is_modules_own(it)}
    sources = sorted({_source(it) for it in named.values()})
    imports = (f"from {it.__module__} import {it.__name__} as {mine}" for mine, it in sorted(named.items()))
    future_import = "from __future__ import annotations\n"
    text = "\n".join([future_import, *imports, "", text.replace(future_import, "")])
    parts = (text, *(sources_digest(file) for file in sources if file), _of_text(text))
    digest = sha256(["\n".join(parts)])[:16]
    whole = f"flockana_{name}_{digest}"
    mine = {key: it for key, it in functions.items() if key not in named}
    with _ONE:
        if not mine and whole in sys.modules:
            return sys.modules[whole]
        module = None if mine else _from_file(text, whole, digest)
        if module is None:
            whole = f"{whole}_{next(_COUNT)}" if mine else whole  # another closure of the same text is another module
            module = ModuleType(whole)
            vars(module).update(mine)
            sys.modules[whole] = module
            exec(compile(text, f"<{whole}>", "exec"), vars(module))
        return module


def _source(known: Kernel) -> str:
    return getattr(sys.modules[known.__module__], "__file__", None) or ""


def _of_text(text: str) -> str:
    """Return a digest of the sources of all package modules that a text imports."""
    names = sorted(set(re.findall(r"^from (flockana\.[\w.]+) import", text, re.MULTILINE)))
    return "".join(sources_digest(str(spec.origin)) for name in names if (spec := find_spec(name)))


def _from_file(text: str, name: str, digest: str) -> ModuleType | None:
    """Return the module from its cached file, written if needed; None if the folder is not writable."""
    base = kernels_folder()
    if base is None:
        return None
    with suppress(OSError):
        path = sources_folder(base, digest) / f"{name}.py"
        if not path.is_file() or path.read_text("utf-8") != text:
            write_atomic(path, text)
        spec = spec_from_file_location(name, path)
        module = module_from_spec(spec)  # type: ignore[arg-type]
        sys.modules[name] = module
        spec.loader.exec_module(module)  # type: ignore[union-attr]
        return module
    return None
