"""What every room stands on: errors, checks of arguments, files, units, references."""

from flockana.base import errors as errors
