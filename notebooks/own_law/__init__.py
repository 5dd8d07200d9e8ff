"""A law, its theorem and its proof, one file each: the example of lecture 11."""
