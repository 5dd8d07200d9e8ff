"""What commands share: their exit statuses and options."""

from __future__ import annotations

from typing import Annotated

import typer

OK, BAD_INPUT, UNEXPECTED, INTERRUPTED = 0, 2, 3, 130

Seed = Annotated[int, typer.Option(min=0, help="Seed of the random starts.")]
