"""Links that are kept: verified, vacuous where nothing joins the flock, refuted where a run is of another law."""

from dataclasses import replace

import numpy as np

import flockana as fl
from flockana.theorems.classics.links_kept import THEOREM


def test_a_chain_holds():
    run = fl.scenario("links-kept").run()
    verdict = fl.verify("links-kept", run)
    assert {claim.name: claim.status for claim in verdict.claims} == dict.fromkeys(
        ("rate", "balance", "links", "connected"), "verified"
    )
    longest = max(np.linalg.norm(np.diff(q, axis=0), axis=1).max() for q in run.q)
    assert verdict.claim("links").computed == longest < verdict.claim("links").margin + longest < 1.0


def test_what_no_link_joins_is_vacuous():
    verdict = fl.verify("links-kept", fl.scenario("links-parted").run())
    assert verdict.claim("connected").status == "vacuous"
    assert verdict.claim("links").status == "verified"
    assert "2 parts" in next(each.detail for each in verdict.hypotheses if each.status == "unmet")


def test_longer_links_than_the_level_allows_are_refuted():
    run = fl.scenario("links-kept").run()
    far = replace(run, law=replace(run.law, r=0.65))  # no run of this law: links grow to 0.7
    claims = {claim.name: claim.status for claim in THEOREM.check(far, fl.Tolerances())[1]}
    assert (claims["links"], claims["connected"]) == ("refuted", "refuted")
