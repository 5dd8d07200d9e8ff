"""Base of all commands: checks of their arguments, and a record of the options given."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any, get_args, get_type_hints

from typer.core import TyperCommand

from flockana.base.errors import ArgumentError, FileError

_FOLDERS = ("DIR", "FOLDER")  # how options for folders are written in the help


class Command(TyperCommand):
    """Command that rejects empty paths, and whose errors name the refused value."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments with typer's rules, after empty paths are refused."""
        arguments, *_ = self.make_parser(ctx).parse_args(args=list(args))
        try:
            left = super().parse_args(ctx, args)
        except Exception as error:  # typer's own kinds, or click's, depending on its version
            value = arguments.get(str(getattr(getattr(error, "param", None), "name", "")))
            format_message: Any = getattr(error, "format_message", None)
            if not isinstance(value, str) or format_message is None or repr(value) in format_message():
                raise
            raise ArgumentError(f"{format_message().rstrip('.')}; got {value!r}") from error
        callback: Any = self.callback
        hints = get_type_hints(inspect.unwrap(callback))
        for param in self.params:
            kind = hints.get(str(param.name))
            is_path = kind is Path or Path in get_args(kind)
            if is_path and arguments.get(str(param.name)) == "":  # as from an unset variable
                name = param.opts[0] if param.param_type_name == "option" else param.metavar
                folder_hint = "; this folder is '.'" if param.metavar in _FOLDERS else ""
                raise FileError(f"{name} '': the name is empty; choose another name{folder_hint}")
        return left
