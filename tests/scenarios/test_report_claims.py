from flockana.scenarios.report_claims import limit_report
from flockana.theorems.limit_certificates import Certificate


def test_a_limit_without_certificate_stays_open():
    assert limit_report(Certificate(-0.5, "it does not fall"), "it still moves").status == "inconclusive"
