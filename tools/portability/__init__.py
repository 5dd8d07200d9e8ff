"""Whether the catalogue keeps its statuses on other machine code, from moved starts, at other tolerances."""
