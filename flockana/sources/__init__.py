"""Sources of laws and theorems: one folder each, named by bibliography key.

A part of a source stands in the file or folder of its kind, such as ``laws.py`` or ``theorems/``, and is imported when
its kind is asked for (`flockana.base.module_discovery.source_modules`). Other sources use public names of a source
alone.
"""
