"""Theorems of the field's classics, one file each."""
