"""Foundations used by every package: errors, argument checks, files, units, references."""

from flockana.base import errors as errors
