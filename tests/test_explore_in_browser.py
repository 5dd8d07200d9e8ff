"""The explorer in headless Chromium: load, play, drag, change a gain, read the verdict; restart, two tabs, axe.

Needs Chromium, playwright (`pip install flockana[browser]`) and tornado (`flockana[explore]`); skipped where one lacks.
"""

import json
import socket
import time
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote

import pytest

from tests.programs import CLI, program, until

AXE = Path(__file__).parent / "axe" / "axe.min.js"
PATIENCE = 120_000  # milliseconds, on a busy machine


@contextmanager
def explorer(folder, *arguments, port=0):
    """The command, and the address that it printed."""
    pytest.importorskip("tornado", reason="tornado is not installed: flockana[explore]")
    said = folder / "said.txt"
    root = Path(__file__).resolve().parents[1]
    with said.open("w") as output:
        options = ("explore", *arguments, "--no-browser", "--port", port)
        with program(
            "-u", "-c", CLI, *options, paths=[root], environment={"HOME": str(folder)}, output=output
        ) as running:
            until(lambda: "token=" in said.read_text(), running)
            yield next(line for line in said.read_text().splitlines() if "token=" in line)


@pytest.fixture(scope="module")
def address(browser, tmp_path_factory):
    with explorer(tmp_path_factory.mktemp("explorer"), "hexagon") as found:
        yield found


@pytest.fixture
def visit(open_tab):
    """Open the explorer, with a case or without, and wait for its first answers."""

    def visit(url, case=None, *, until="data-done", **how):
        tab = open_tab(url + ("" if case is None else "#" + quote(json.dumps(case))), reduced_motion="reduce", **how)
        tab.wait_for_selector(f"body[{until}='1']")
        return tab

    return visit


def done(tab, number):
    """Wait until a question and all after it are answered in full."""
    tab.wait_for_selector(f"body[data-done='{number}']")


def asked(tab):
    return int(tab.locator("body").get_attribute("data-done"))


def status(tab, theorem):
    return tab.locator(f"#verdict-{theorem} .status").first.inner_text()


def change(tab, name, value):
    """Type a number, and wait for all that it changes."""
    before = asked(tab)
    tab.fill(f"[id='{name}']", str(value))
    tab.locator(f"[id='{name}']").press("Tab")
    done(tab, before + 1)


def test_it_plays(visit, address):
    tab = visit(address)
    assert tab.locator("#title").inner_text().startswith("Seven agents")
    clock = tab.locator(".fp-clock")
    assert clock.inner_text() == "t = 0"
    tab.get_by_role("button", name="Play").click()
    tab.locator(".fp-clock", has_text="t = 1").first.wait_for()
    tab.get_by_role("button", name="Pause").click()
    assert tab.locator(".fp-row").count() > 5
    marks = tab.locator(".fp-marks button")
    assert marks.first.inner_text().startswith("t = 0: energy rate")  # where claims of the verdicts point
    tab.get_by_role("button", name="t = 30: os-1 ii", exact=True).click()
    tab.locator(".fp-clock", has_text="t = 30").wait_for()


def test_a_changed_gain_changes_the_verdict_and_the_python(visit, address):
    tab = visit(address)
    assert [status(tab, name) for name in ("energy", "os-1", "alpha-flocking")] == 3 * ["verified"]
    tab.locator("#verdict-os-1 summary").click()
    hypotheses = tab.locator("#verdict-os-1 [aria-label=Hypotheses]")
    assert (hypotheses.locator(".met").count() > 0, hypotheses.locator(".unmet").count()) == (True, 0)
    change(tab, "number-gains.c2_alpha", 0)  # without damping it never comes to rest
    assert [status(tab, name) for name in ("energy", "os-1", "alpha-flocking")] == ["verified", "vacuous", "refuted"]
    assert hypotheses.locator(".unmet").count() > 0
    assert "c2_alpha=0.0" in tab.locator("#python").inner_text()
    assert tab.locator("#verdict-os-1").get_attribute("open") is not None  # what was open stays open
    change(tab, "number-gains.c2_alpha", 10.954451150103322)
    assert status(tab, "os-1") == "verified"


def test_a_number_that_is_refused_says_why_and_the_next_is_taken(visit, address):
    tab = visit(address)
    change(tab, "number-alpha.r", 3)
    assert "expected r > d" in tab.locator("#wrong").inner_text()
    change(tab, "number-alpha.r", 8.4)
    assert not tab.locator("#wrong").is_visible()
    tab.fill("[id='number-alpha.r']", "")
    tab.locator("[id='number-alpha.r']").press("Tab")
    assert tab.locator("[id='number-alpha.r']").get_attribute("aria-invalid") == "true"


def test_an_agent_is_dragged(visit, address):
    tab = visit(address, {"kind": "law", "name": "Algorithm1", "n": 3, "duration": 1})
    before = places(tab)
    box = tab.locator("#player canvas").bounding_box()
    x, y = agents(tab)[0]
    tab.mouse.move(box["x"] + x, box["y"] + y)
    tab.mouse.down()
    tab.mouse.move(box["x"] + x + 30, box["y"] + y - 20, steps=4)
    tab.mouse.up()
    done(tab, 2)
    after = places(tab)
    assert after[1:] == before[1:]
    (dx, dy), scale = (after[0][c] - before[0][c] for c in range(2)), agents_scale(tab, before)
    assert dx * scale == pytest.approx(30.0, abs=1.5)
    assert dy * scale == pytest.approx(20.0, abs=1.5)
    assert "q0[0] = (" in tab.locator("#python").inner_text()


def test_an_obstacle_and_the_target_are_dragged(visit, address):
    tab = visit(address, {"kind": "law", "name": "Algorithm3", "n": 3, "duration": 1})
    number = "[id='number-{}-{}']".format
    for colour, path in (((198, 83, 0), "target.q"), ((227, 227, 221), "obstacles.0.centre")):
        before = [float(tab.input_value(number(path, c))) for c in range(2)]
        box, (x, y) = tab.locator("#player canvas").bounding_box(), centre(tab, colour)
        tab.mouse.move(box["x"] + x, box["y"] + y)
        tab.mouse.down()
        tab.mouse.move(box["x"] + x + 10, box["y"] + y + 40, steps=4)
        tab.mouse.up()
        done(tab, asked(tab) + 1)
        dx, dy = (float(tab.input_value(number(path, c))) - before[c] for c in range(2))
        assert dy < 0.0 < dx
        assert dy == pytest.approx(-4.0 * dx, rel=0.01)
    assert "obstacles=(replace(law.obstacles[0], centre=(" in tab.locator("#python").inner_text()
    assert "target=replace(law.target, q=(" in tab.locator("#python").inner_text()


def centre(tab, colour):
    """Middle of the pixels of one colour in the player's picture."""
    return tab.evaluate(
        """([r, g, b]) => {
          const c = document.querySelector("#player canvas"), ink = c.getContext("2d");
          const { data, width, height } = ink.getImageData(0, 0, c.width, c.height);
          let [x, y, n] = [0, 0, 0];
          for (let i = 0; i < width * height; i++) {
            if (data[4 * i] !== r || data[4 * i + 1] !== g || data[4 * i + 2] !== b || data[4 * i + 3] < 255) continue;
            x += i % width; y += Math.floor(i / width); n += 1;
          }
          return [x / n / (c.width / c.clientWidth), y / n / (c.width / c.clientWidth)];
        }""",
        colour,
    )


def places(tab):
    """Of the agents, as the form has them."""
    number, found = tab.get_by_label("Number of the agent"), []
    for k in range(3):
        number.fill(str(k))
        found.append([float(tab.get_by_label(f"{c} of the agent").input_value()) for c in "xy"])
    return found


def agents(tab):
    """Pixels of the agents in the canvas: the dark dots, found in the picture itself."""
    tab.get_by_label("trails").uncheck()
    tab.get_by_label("velocities").uncheck()
    tab.get_by_label("links").uncheck()
    tab.wait_for_timeout(100)
    return sorted_like(tab, dots(tab))


def dots(tab):
    return tab.evaluate(
        """() => {
          const c = document.querySelector("#player canvas"), ink = c.getContext("2d");
          const { data, width, height } = ink.getImageData(0, 0, c.width, c.height), seen = [];
          for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) {
            const k = 4 * (y * width + x);
            if (data[k + 3] < 200) continue;
            const near = seen.find((s) => Math.hypot(s[0] / s[2] - x, s[1] / s[2] - y) < 12);
            if (near) { near[0] += x; near[1] += y; near[2] += 1; } else seen.push([x, y, 1]);
          }
          const ratio = c.width / c.clientWidth;
          return seen.map(([x, y, n]) => [x / n / ratio, y / n / ratio]);
        }"""
    )


def sorted_like(tab, found):
    """Dots in the order of the agents: both sorted from left to right."""
    order = sorted(range(3), key=lambda k: places(tab)[k][0])
    by_agent = dict(zip(order, sorted(found), strict=True))
    return [by_agent[k] for k in range(3)]


def agents_scale(tab, before):
    """Pixels per length, from two agents that were not moved."""
    now = agents(tab)
    return abs(now[1][0] - now[2][0]) / abs(before[1][0] - before[2][0])


def test_poles_and_a_mode_that_moves_when_chosen(visit, address):
    tab = visit(address)
    assert tab.locator("#poles svg circle").count() == 28  # 2 n m
    modes = tab.locator(".modes button")
    assert modes.first.get_attribute("aria-pressed") == "true"
    assert tab.locator("#poles circle.chosen").count() == 2  # breathing, and its conjugate
    modes.nth(2).click()
    assert [modes.nth(k).get_attribute("aria-pressed") for k in (0, 2)] == ["false", "true"]
    assert "Mode" in tab.locator("#poles canvas").get_attribute("aria-label")
    assert tab.locator("#poles circle.chosen").count() == 4  # a double one


@pytest.mark.parametrize(("dark", "width"), [(False, 1280), (True, 390)])
def test_it_is_accessible_and_as_wide_as_its_window(visit, address, dark, width):
    tab = visit(address, {"kind": "law", "name": "Algorithm2", "n": 7, "duration": 2}, dark=dark, width=width)
    tab.locator(".mark i").wait_for(state="attached")  # the threshold of collapse
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    tab.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    tab.evaluate(AXE.read_text(encoding="utf-8") + "; 0")
    found = tab.evaluate("axe.run().then((r) => r.violations.map((v) => [v.id, v.nodes.map((n) => n.target[0])]))")
    assert found == []


def test_it_finds_the_server_again(browser, visit, tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with explorer(tmp_path, "hexagon", port=port) as url:
        tab = visit(url, quiet=False)  # that a connection is refused is an error in the console
        change(tab, "number-gains.c1_alpha", 20)
    tab.locator("#said", has_text="no connection").wait_for()
    with explorer(tmp_path, "hexagon", port=port) as again:
        assert again == url
        tab.locator("#said", has_text="done").wait_for()
        assert "c1_alpha=20.0" in tab.locator("#python").inner_text()
        change(tab, "number-gains.c1_alpha", 30)


def test_time_is_kept(visit, address):
    tab = visit(address)
    tab.locator("#player canvas").focus()
    tab.keyboard.press("End")
    until_text(tab.locator(".fp-clock"), "t = 30")
    change(tab, "start-duration", 12)
    until_text(tab.locator(".fp-clock"), "t = 12")  # who looks at the end looks at the new end


def until_text(place, text):
    end = time.monotonic() + 1e-3 * PATIENCE
    while place.inner_text() != text and time.monotonic() < end:
        time.sleep(0.05)
    assert place.inner_text() == text


def test_field_run_and_code_never_differ_when_a_change_is_undone_in_the_field_itself(visit, address):
    tab = visit(address)
    field = tab.locator("[id='number-gains.c1_alpha']")
    field.fill("5")
    field.press("Enter")
    tab.locator("#python", has_text="c1_alpha=5").wait_for()
    field.focus()
    tab.keyboard.press("Control+z")
    tab.locator("#python", has_not_text="c1_alpha=5").wait_for()
    assert field.input_value() == "30"
    tab.click("#redo")
    tab.locator("#python", has_text="c1_alpha=5").wait_for()
    until_text(tab.locator("#said"), "done")
    assert field.input_value() == "5"
    chip = tab.locator("#strip button").first
    box = chip.bounding_box()
    assert box["y"] < 300  # beside the canvas, seen without scrolling
    assert chip.get_attribute("data-status") == "verified"
    with tab.expect_download() as saved:
        tab.click("#save")
    assert saved.value.suggested_filename == "hexagon.nc"
    tab.select_option("#start", "scenario:paper-flocking")
    tab.locator("#cancel:enabled").wait_for()
    tab.click("#cancel")
    until_text(tab.locator("#said"), "cancelled")
