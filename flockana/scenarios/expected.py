"""Expected statuses of a scenario: ``verified("energy", "os-3:i") | refuted("E11")``."""

from flockana.theorems.theorem import Status


def verified(*ids: str) -> dict[str, Status]:
    """Return the status `verified` for theorems and claims."""
    return dict.fromkeys(ids, "verified")


def refuted(*ids: str) -> dict[str, Status]:
    """Return the status `refuted` for theorems and claims."""
    return dict.fromkeys(ids, "refuted")


def vacuous(*ids: str) -> dict[str, Status]:
    """Return the status `vacuous` for theorems and claims."""
    return dict.fromkeys(ids, "vacuous")


def inconclusive(*ids: str) -> dict[str, Status]:
    """Return the status `inconclusive` for theorems and claims."""
    return dict.fromkeys(ids, "inconclusive")
