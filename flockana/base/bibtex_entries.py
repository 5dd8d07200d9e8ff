"""BibTeX entries of the sources of laws and theorems."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.module_discovery import source_files


@cache
def bibliography() -> Mapping[str, str]:
    """Return all BibTeX entries by key, from the ``KEY.bib`` files of the sources."""
    paths = sorted(source_files("*.bib"), key=lambda path: path.stem)
    return {path.stem: path.read_text(encoding="utf-8").strip() for path in paths}


def cite(item: Any) -> str:
    """Return the BibTeX entries of the sources of an object, or of a key of the bibliography.

    A law or theorem of your own brings its entries itself: a reference that begins with @ is BibTeX as it stands.

    Parameters
    ----------
    item : str or object
        A key such as ``"olfati-saber-2006"``, or a theorem, scenario or law with a `references` attribute.

    Examples
    --------
    >>> cite("olfati-saber-2006").splitlines()[0]
    '@article{olfatisaber2006flocking,'
    """
    keys = (item,) if isinstance(item, str) else tuple(getattr(item, "references", ()))
    if not keys or any(key not in bibliography() and not key.startswith("@") for key in keys):
        raise ArgumentError(
            f"nothing to cite for {item!r}: expected an object with references, or one of {', '.join(bibliography())}"
        )
    return "\n\n".join(bibliography().get(key, key) for key in keys)
