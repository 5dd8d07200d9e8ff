"""Drawn figures are part of the page: in its colours, with ids of their own, and named."""

from __future__ import annotations

import re

from flockana.report.image import named, svg


def lines(figure):
    ax = figure.subplots()
    ax.plot([0.0, 1.0], [0.0, 1.0], "o", color="#0072B2", label="a <curve>")
    ax.legend()


def test_colours_are_the_page_s_and_texts_are_texts():
    text = svg(lines, (4.0, 3.0))
    assert text.startswith('<svg viewBox="0 0 288 216" class="drawn">')
    assert "var(--blue)" in text
    assert "a &lt;curve&gt;</text>" in text
    assert not re.search(r"#0072b2|#ffffff|#222222|<style|http", text)


def test_ids_are_unique_in_a_page_and_lead_where_they_did():
    text = svg(lines, (4.0, 3.0))
    first, second = (named(text, 'a "name"', number) for number in (1, 2))
    ids = [re.findall(r' id="([^"]*)"', each) for each in (first, second)]
    assert ids[0]
    assert not set(ids[0]) & set(ids[1])
    assert set(re.findall(r'(?:href="#|url\(#)([^")]+)', first)) == set(ids[0])
    assert 'aria-label="a &quot;name&quot;"' in first
