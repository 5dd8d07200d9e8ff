"""The command line: one file per command; they load in no time, what they need with them."""
