"""The commands that measure lattices and find equilibria; their modules load in no time, what they need with them."""
