"""Terms of laws, one per file: the pair term, the pull to the γ-agent, the repulsion from obstacles, and others."""
