import re

from flockana.report.image import _short, named, svg


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


def test_long_paths_lose_repeated_points_and_hundredths_short_ones_only_spaces():
    assert _short("M 0.50 -1.25 C 0 1.00 10 20.05 3.10 4 z ") == "M0.5 -1.25C0 1 10 20.05 3.1 4z"
    points = "M 0 0 " + "L 10.00 20.06 " * 40 + "L 10.04 20.09 L 3.19 100"
    assert _short(points) == "M0 0L10 20L3.1 100"
