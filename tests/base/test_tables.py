from flockana.base.tables import facts_html, facts_text, html_table, latex_table, tex, text_table


def test_tables_as_text_html_and_latex():
    assert tex("c1α > 5% of ψ_α") == r"c1$\alpha$ > 5\% of $\psi$\_$\alpha$"
    assert html_table([["i", "verified"]], ["claim", "status"])[:24] == "<table><thead><tr><th sc"
    rows = [["os-3", "verified"], ["energy", "refuted"]]
    assert text_table(rows, ["theorem", "status"]).split() == ["theorem", "status", *rows[0], *rows[1]]
    lines = latex_table([["i", "verified"]], ["claim", "status"], "ll").splitlines()
    assert lines[0] == r"\begin{tabular}{ll}"
    assert lines[2] == r"claim & status \\"
    assert lines[4] == r"i & verified \\"
    assert "<td" in facts_html("run", {"agents": 7})
    assert facts_text("run", {"agents": 7, "m": 2}) == "run\n  agents  7\n  m       2"
