"""What every room stands on: errors, checks of arguments, files, units, references."""
