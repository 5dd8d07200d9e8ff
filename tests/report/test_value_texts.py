from flockana.report.value_texts import markup, source_name


def test_values_and_sources_as_markup():
    assert markup({"pair": (1, 2)}) == "pair: (1, 2)"
    nested = '<details class="values"><summary>1 entry</summary><dl><dt>a</dt><dd>b: 1</dd></dl></details>'
    assert markup({"a": {"b": 1.0}}) == nested
    assert [source_name("olfati-saber-2006"), source_name("msn-2013")] == ["Olfati-Saber 2006", "MSN 2013"]
