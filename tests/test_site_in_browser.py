"""Pages of the site as `make docs` left them, in headless Chromium: quiet, accessible, found by the search, played.

Of a draft (`make docs OPTIONS=--draft`) what it has; a page that plays a run is in the whole site alone.
"""

from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

import pytest

HERE = Path(__file__).resolve().parent
HTML = HERE.parent / "site" / "html"
FOUND = "search.html?q=Theorem+3"
PAGES = ("start.html", "generated/theorems/os-3.html", "generated/scenarios/hexagon.html", "howto/verify.html", FOUND)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass


@pytest.fixture(scope="module")
def address():
    """The site as a server gives it: of a file a page may not read another, and the search shows no excerpts."""
    if not (HTML / "index.html").exists():
        pytest.skip("the site is not built: make docs")
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=HTML)) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture
def visit(open_tab, address):
    """Open a page of the site."""
    return lambda name, **how: open_tab(f"{address}/{name}", **how)


def typeset(tab):
    tab.wait_for_function("!window.MathJax || !MathJax.startup || MathJax.startup.promise.then(() => true)")


def too_wide(tab):
    return tab.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


@pytest.mark.parametrize(("dark", "width"), [(False, 1280), (True, 390)])
@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_quiet_fits_and_can_be_read_by_all(visit, name, width, dark):
    tab = visit(name, width=width, dark=dark)
    typeset(tab)
    if name == FOUND:
        tab.wait_for_selector("#search-results .highlighted")
    unnamed = "[...document.images].filter(i => !i.alt && i.getAttribute('role') !== 'presentation').length"
    assert tab.evaluate(unnamed) == 0
    assert too_wide(tab) <= 0
    cut = (
        "[...document.querySelectorAll('.bd-breadcrumbs .ellipsis')].filter(e => e.scrollWidth > e.clientWidth).length"
    )
    assert tab.evaluate(cut) == 0
    tab.add_script_tag(path=str(HERE / "axe" / "axe.min.js"))
    found = tab.evaluate("axe.run('main', {preload: false, iframes: false, runOnly: ['wcag2a', 'wcag2aa']})")
    assert [(one["id"], one["nodes"][0]["html"][:120]) for one in found["violations"]] == []


@pytest.mark.parametrize("width", [1280, 390])
def test_every_formula_is_typeset_and_wide_ones_scroll_in_themselves(visit, width):
    """The page with the most formulas; for axe it has too many elements."""
    tab = visit("generated/mathematics.html", width=width)
    typeset(tab)
    assert tab.locator("mjx-container").count() > 150
    assert tab.locator("mjx-merror").count() == 0
    assert too_wide(tab) <= 0


@pytest.mark.parametrize(
    ("words", "page"),
    [
        ("cohesive matched", "theorems/os-3"),
        ("Theorem 3", "theorems/os-3"),
        ("paper-split-rejoin", "scenarios/paper-split-rejoin"),
        ("falsify", "howto/falsify"),
    ],
)
def test_the_search_finds(visit, words, page):
    tab = visit(f"search.html?q={words.replace(' ', '+')}")
    tab.wait_for_selector("#search-results li a")
    tab.wait_for_function(
        "[...document.querySelectorAll('#search-results li')].slice(0, 6)"
        f".some(li => li.querySelector('a').href.includes('{page}'))"
    )


def test_a_scenario_plays_in_its_page(visit):
    if not (HTML / "runs" / "hexagon.html").exists():
        pytest.skip("the site is a draft, without runs")
    tab = visit("generated/scenarios/hexagon.html")
    tab.locator("iframe.run").scroll_into_view_if_needed()
    frame = tab.frame_locator("iframe.run")
    frame.get_by_role("button", name="Play").click()
    frame.get_by_role("button", name="Pause").click()
    assert frame.locator(".fp-clock").inner_text() != "t = 0"
