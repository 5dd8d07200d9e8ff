"""Rigour and citations of the executable proofs named in claims."""

from flockana.theorems.theorem import Rigour

_PROOFS: dict[Rigour, str] = {
    "symbolic": "certified-basins constant-acceleration deviation-energy disturbed-basins energy-identities "
    "nonplanar-fcc singular-pair smoothness stand-off turned-axes",
    "smt": "any-potential any-potential-limits average-consensus avoided-collisions bearing-distance "
    "bearing-distance-printed cohesion collisions convergence cucker-smale cyclic-pursuit dead-zone "
    "distance-formation finite-time gazi-passino growing-windows headings informed-agents links-kept "
    "matched-velocities net-consensus net-measures own-sums rooted-averaging second-order-modes "
    "safety-filter singular-alignment tanner theorem5-counts theorem5-crossings theorem6",
    "interval": "barrier compressed-patches delayed-consensus distinct-pairs double-agent n-max speed-bound "
    "strained-thirteen tracking-gain",
}
RIGOUR: dict[str, Rigour] = {proof: rigour for rigour, proofs in _PROOFS.items() for proof in proofs.split()}

CITES: dict[str, tuple[str, ...]] = {
    "any-potential-limits": ("Barbalat", "LaSalle"),
    "avoided-collisions": ("Barbalat",),
    "distance-formation": ("Barbalat",),
    "gazi-passino": ("Barbalat", "LaSalle"),
    "convergence": ("Łojasiewicz", "centre-stable manifold"),
    "matched-velocities": ("Barbalat",),
}
