"""Theorems about every composition of terms, one file each."""
