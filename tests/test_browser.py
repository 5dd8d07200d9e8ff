"""The report and the player in a real browser: no error, accessible, filtered, played; skipped where there is none.

Needs Chromium and playwright (`pip install flockana[browser]`; no browser of playwright's own). axe-core, which is used
here only, is in tests/axe with its licence.
"""

import base64
from pathlib import Path

import numpy as np
import pytest

from flockana import Algorithm1, MinimalFlocking, scenario, simulate
from flockana.player.page import page
from flockana.player.run_codec import Packed, decode, encode
from flockana.player.scene import scene
from flockana.report.page_data import fixed_page, scenario_page
from flockana.report.report_writer import write_report
from flockana.theorems import Claim, Verdict, verify

AXE = Path(__file__).parent / "axe" / "axe.min.js"


@pytest.fixture
def visit(open_tab):
    """Open a file, which asks nothing of any server."""
    return lambda path, **how: open_tab(path.as_uri(), offline=True, **how)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    pages = []
    for name in ("hexagon", "three-agents-1d"):
        item = scenario(name)
        run = item.run()
        pages.append(scenario_page(item, run, (item.verdict("energy", run),) if name == "hexagon" else ()))
    derived = Verdict("E1", (), (Claim("corrected", "verified", "symbolic"),))
    pages += [fixed_page(verify("E8")), fixed_page(derived)]
    return write_report(pages, tmp_path_factory.mktemp("report"))


@pytest.fixture(scope="module")
def run():
    rng = np.random.default_rng(0)
    return simulate(Algorithm1(), rng.normal(0.0, 12.0, (20, 2)), rng.normal(0.0, 1.0, (20, 2)), (0.0, 2.0))


def violations(tab):
    tab.add_script_tag(content=AXE.read_text(encoding="utf-8"))
    found = tab.evaluate("axe.run().then((r) => r.violations.map((v) => [v.id, v.nodes.map((n) => n.target[0])]))")
    return [(name, places[:3]) for name, places in found]


def played(path, data):
    path.write_text(page(data), encoding="utf-8")
    return path


@pytest.mark.parametrize(("dark", "width"), [(False, 1280), (True, 390)])
def test_the_report_is_accessible_and_as_wide_as_its_window(visit, report, dark, width):
    tab = visit(report, dark=dark, width=width)
    tab.locator("#open-all").click()
    tab.wait_for_selector(".fp-row")
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    assert violations(tab) == []


def test_on_a_phone_each_number_has_its_name_and_paper_leaves_what_is_closed(visit, report):
    tab = visit(report, width=390)
    name = "getComputedStyle(document.querySelector('.summary tbody:not(:first-of-type) .number'), '::before').content"
    assert tab.evaluate(name) == '"margin "'
    assert "none" in visit(report).evaluate(name)
    tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert tab.locator("section.scenario > details[open]").count() == 0


def test_sections_are_drawn_when_a_link_opens_them(visit, report):
    tab = visit(report)
    assert not tab.locator("#fixed ~ *, .by-itself").first.is_visible()
    tab.locator("nav a[href='#fixed']").click()
    assert tab.locator(".by-itself").first.is_visible()


def test_the_report_is_filtered(visit, report):
    tab = visit(report)
    count = tab.locator("#filter output")
    whole = count.inner_text()
    assert whole == "3 of 3 verdicts"
    tab.fill("[name=words]", "hexagon")
    assert count.inner_text() == "1 of 3 verdicts"
    assert tab.locator("section.scenario:visible").count() == 1
    tab.fill("[name=words]", "")
    tab.select_option("[name=rigour]", "smt")
    assert count.inner_text() == "1 of 3 verdicts"
    tab.select_option("[name=rigour]", "")
    tab.select_option("[name=status]", "inconclusive")
    assert count.inner_text() == "0 of 3 verdicts"


def test_runs_are_decoded_when_their_section_opens_and_a_link_opens_it(visit, report):
    tab = visit(report)
    assert tab.locator("canvas").count() == 0
    tab.locator(".summary a[href='#scenario-hexagon--energy']").click()
    tab.wait_for_selector("#scenario-hexagon canvas")
    assert tab.locator("canvas").count() == 1
    assert tab.locator("#scenario-hexagon--energy").is_visible()


def test_without_javascript_all_is_there_but_the_player(browser, report):
    context = browser.new_context(java_script_enabled=False)
    tab = context.new_page()
    tab.goto(report.as_uri())
    assert not tab.locator("#filter").is_visible()
    tab.locator("#scenario-hexagon > summary").click()
    assert tab.locator("#scenario-hexagon svg").first.is_visible()
    context.close()


def test_the_page_decodes_what_was_encoded(visit, run, tmp_path):
    for exact in (True, False):
        data = scene(run, exact=exact)
        tab = visit(played(tmp_path / "run.html", data))
        tab.wait_for_selector(".fp-row")
        source = (Path(__file__).parents[1] / "flockana" / "player" / "decode.js").read_text(encoding="utf-8")
        text = base64.b64encode(data).decode()
        tab.add_script_tag(content=source)
        got = tab.evaluate(f"decodeRun(bytesOfText('{text}')).then((r) => [Array.from(r.q), Array.from(r.t)])")
        step = 0.0 if exact else np.ptp(run.q) / 2.0**13
        np.testing.assert_allclose(got[0], run.q.astype(np.float32).ravel(), rtol=1e-6, atol=0.51 * step)
        np.testing.assert_array_equal(got[1], run.t.astype(np.float32))


def test_the_player_plays_pauses_and_answers_keys(visit, run, tmp_path):
    tab = visit(played(tmp_path / "run.html", scene(run, marks=[(1.5, "there")])))
    tab.wait_for_selector(".fp-row")
    clock, start = tab.locator(".fp-clock"), tab.get_by_role("button", name="Play")
    assert clock.inner_text() == "t = 0"
    start.click()
    tab.wait_for_function("document.querySelector('.fp-clock').textContent !== 't = 0'")
    tab.get_by_role("button", name="Pause").click()
    tab.get_by_role("button", name="t = 1.5: there").click()
    tab.wait_for_function("document.querySelector('.fp-clock').textContent === 't = 1.5'")
    assert tab.locator("[aria-live=polite]").inner_text().startswith("t = 1.5; energy H")
    tab.locator("canvas").focus()
    for key, text in (("End", "t = 2"), ("ArrowLeft", "t = 1.98"), ("Home", "t = 0"), ("ArrowRight", "t = 0.02")):
        tab.keyboard.press(key)
        tab.wait_for_function(f"document.querySelector('.fp-clock').textContent === '{text}'")
    energy = float(tab.locator(".fp-row output").first.inner_text())
    assert energy == pytest.approx(np.interp(0.02, run.t, run.energy()), rel=2e-3)
    assert violations(tab) == []


def made(**world):
    """Three instants of one agent in space, with this world: as `scene` gives it."""
    header = {
        **{"n": 1, "m": 3, "title": "made", "reach": None, "length": None, "edge_counts": [], "solids": []},
        **{"outlines": [], "beta": 0.0, "groups": [], "marks": []},
        **{"series": [{"name": "a", "label": "a", "log": False}]},
    }
    q = np.array([[[0.0, 0.0, 0.0]], [[4.0, 0.0, 0.0]], [[4.0, 4.0, 4.0]]])
    t = np.array([0.0, 1.0, 2.0])
    arrays = {"t": t, "q": q, "p": 0.0 * q, "series_t": t, "series_0": np.array([0.0, 10.0, -5.0])}
    return encode(header | world, {name: Packed(values) for name, values in arrays.items()})


def test_the_strip_shows_the_value_of_the_nearest_sample(visit, tmp_path):
    tab = visit(played(tmp_path / "run.html", made(marks=[{"t": t, "label": "x"} for t in (0.4, 0.6, 1.4, 1.6)])))
    tab.wait_for_selector(".fp-row")
    for time, value in ((0.4, 0), (0.6, 10), (1.4, 10), (1.6, -5)):
        tab.get_by_role("button", name=f"t = {time}: x").click()
        tab.wait_for_function(f"document.querySelector('.fp-clock').textContent === 't = {time}'")
        assert tab.locator(".fp-row output").inner_text() == str(value)


def test_in_space_walls_and_wires_are_drawn(visit, tmp_path):
    wall = {"kind": "wall", "par": [0.0, 0.0, -1.0, 0.0, 0.0, 1.0]}
    wire = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 4.0, 1.0], [0.0, 4.0, 1.0], [0.0, 2.0, 1.0]]
    inked = []
    for world in ({}, {"solids": [wall]}, {"outlines": [wire]}):
        tab = visit(played(tmp_path / "run.html", made(**world)))
        tab.wait_for_selector(".fp-row")
        tab.wait_for_timeout(100)
        inked.append(
            tab.evaluate(
                "(() => { const c = document.querySelector('canvas'), d = c.getContext('2d').getImageData(0, 0, "
                "c.width, c.height).data; let sum = 0; for (let i = 3; i < d.length; i += 4) sum += d[i] > 0; "
                "return sum; })()"
            )
        )
    none, grid, line = inked
    assert grid > none + 2000  # ten lines of hundreds of pixels
    assert none + 100 < line < none + 4000  # a line, and not a filled face


def pixels(tab):
    return tab.evaluate("document.querySelector('canvas').toDataURL()")


def test_zoom_pan_and_turning_change_the_picture_and_fit_brings_it_back(visit, tmp_path):
    q = np.random.default_rng(0).normal(size=(8, 3))
    space = simulate(MinimalFlocking((1.0,) * 3, edges=((0, 1), (1, 2))), q[:3], 0.0 * q[:3], (0.0, 1.0))
    tab = visit(played(tmp_path / "run.html", scene(space)))
    tab.wait_for_selector(".fp-row")
    tab.wait_for_timeout(100)
    seen = [pixels(tab)]
    box = tab.locator("canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.mouse.move(x, y)
    tab.mouse.down()
    tab.mouse.move(x + 80, y + 10)
    tab.mouse.up()
    tab.wait_for_timeout(100)
    turned = pixels(tab)
    seen.append(turned)
    tab.get_by_role("button", name="Zoom in").click()
    tab.wait_for_timeout(100)
    seen.append(pixels(tab))
    assert len(set(seen)) == 3
    tab.get_by_role("button", name="Fit").click()
    tab.wait_for_timeout(100)
    assert pixels(tab) == turned


def test_a_damaged_run_says_so(visit, tmp_path):
    tab = visit(played(tmp_path / "run.html", b"FLK1 damaged"))
    tab.wait_for_function("document.querySelector('#player').textContent.startsWith('This run cannot be shown here')")


NOTEBOOK = """\
import flockana as fl
q = [[0.0, 0.0], [7.0, 0.0], [3.0, 6.0]]
shown = fl.simulate(fl.Algorithm1(), q, [[0.0, 0.0]] * 3, (0.0, 2.0)).player().widget()
shown.time = 1.5
shown
"""
FRONT_END = """async ([code, css, data, time]) => {
  const sheet = document.createElement("style");
  sheet.textContent = css;
  document.head.append(sheet);
  const state = { data: new DataView(Uint8Array.from(atob(data), (c) => c.charCodeAt(0)).buffer), time }, heard = {};
  window.model = {
    saved: 0, get: (name) => state[name], save_changes() { this.saved++; },
    on: (event, act) => { heard[event] = act; },
    set(name, value) {
      if (state[name] === value) return;
      state[name] = value;
      if (heard[`change:${name}`]) heard[`change:${name}`]();
    },
  };
  const widget = await import(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
  window.leave = widget.default.render({ model: window.model, el: document.body });
}"""  # what a notebook does with an anywidget


def test_a_widget_leaves_the_kernel_whole_and_its_time_goes_both_ways(visit, tmp_path):
    """The kernel sends what a front end needs; the start of a kernel takes its seconds."""
    pytest.importorskip("anywidget", reason="anywidget is not installed: flockana[notebook]")
    pytest.importorskip("ipykernel")
    client, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(NOTEBOOK)])
    book = client.NotebookClient(book, timeout=120, kernel_name="python3", store_widget_state=True).execute()
    view = book.cells[0].outputs[0]["data"]["application/vnd.jupyter.widget-view+json"]
    model = book.metadata["widgets"]["application/vnd.jupyter.widget-state+json"]["state"][view["model_id"]]
    (buffer,) = model["buffers"]
    assert (buffer["path"], buffer["encoding"]) == (["data"], "base64")
    header, arrays = decode(base64.b64decode(buffer["data"]))
    assert (header["n"], arrays["t"][-1]) == (3, 2.0)
    (tmp_path / "empty.html").write_text('<!doctype html><html lang="en"><title>A notebook</title><body></body></html>')
    tab = visit(tmp_path / "empty.html")
    state = model["state"]
    tab.evaluate(FRONT_END, [state["_esm"], state["_css"], buffer["data"], state["time"]])
    clock = "document.querySelector('.fp-clock').textContent"
    tab.wait_for_selector("canvas")
    tab.wait_for_function(f"{clock} === 't = 1.5'")
    tab.evaluate("model.set('time', 0.5)")  # as when the notebook's code sets it
    tab.wait_for_function(f"{clock} === 't = 0.5'")
    tab.locator("canvas").focus()
    tab.keyboard.press("End")
    tab.wait_for_function("model.get('time') === 2 && model.saved > 0")
    tab.evaluate("leave()")
    assert tab.locator("canvas").count() == 0
