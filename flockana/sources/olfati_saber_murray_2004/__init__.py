"""Olfati-Saber and Murray (2004): consensus under a delay."""
