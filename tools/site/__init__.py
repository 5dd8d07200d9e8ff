"""The documentation site: what is written by machine, and the check of the links (`python -m tools.site`)."""
