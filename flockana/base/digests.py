"""SHA-256 of text and bytes, by which files, seals, stores and caches know their contents."""

import hashlib
from collections.abc import Iterable
from typing import Any


def sha256(parts: Iterable[Any]) -> str:
    """Return the SHA-256 of texts and buffers of bytes, one after another, as 64 hexadecimal digits.

    Examples
    --------
    >>> sha256(["ab", b"c"])[:16]
    'ba7816bf8f01cfea'
    """
    total = hashlib.sha256()
    for text_part in parts:
        total.update(text_part.encode() if isinstance(text_part, str) else text_part)
    return total.hexdigest()
