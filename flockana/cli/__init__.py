"""Command line, one file per command; imports are deferred until needed."""
