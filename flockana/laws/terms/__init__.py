"""The summands of a law, one file each: the pair term, the pull to the γ-agent, the repulsion from obstacles."""
