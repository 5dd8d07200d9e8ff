"""Shared settings: hypothesis runs the same examples every time, and never judges by the clock.

With ``--attack N`` it draws N new ones for each test of tests/adversarial, from a seed that is printed.
"""

from __future__ import annotations

import gc
import os
import secrets
import shutil
import signal
from functools import cache
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# Before anything loads numpy, and for all that is started: a worker has one core, and threads that share it spin.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# Folders and files whose tests are all marked slow: `make test-all` and CI run them, `make test` does not.
SLOW = (
    *("adversarial", "benchmarks", "tools", "ensemble/test_processes.py"),
    *("base/test_interrupts.py", "proofs"),
    *("explore/test_server.py", "explore/test_worker.py", "test_jit.py"),
    *("test_time_limits.py", "test_browser.py", "test_explore_in_browser.py", "test_site_in_browser.py"),
    "test_types_of_a_script.py",
    *("falsify", "certified", "lammps", "bad_input", "test_one_file.py", "equilibria/test_descent.py"),
    *("kernels/test_pole_crossings.py", "theorems/test_attraction.py"),
    *(
        "sources/li_dead_zone/theorems/test_range_limits.py",
        "sources/li_dead_zone/theorems/test_l09_leaders.py",
        "reference/test_energy_balance.py",
    ),
    "sources/jond_2025/theorems/test_tree_limits.py",
)
collect_ignore = ["toys"]  # files that stand in the package's own folders while test_one_file.py runs

settings.register_profile(
    "flockana",
    deadline=None,
    derandomize=True,
    max_examples=40,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],  # the clock of a busy machine
)
settings.load_profile("flockana")


def pytest_addoption(parser):
    text = "attack the verdicts: N new examples for each test of tests/adversarial, and its long tests too"
    parser.addoption("--attack", type=int, default=0, metavar="N", help=text)


@pytest.hookimpl(tryfirst=True)  # before hypothesis reads its seed
def pytest_configure(config):
    from flockana.base.garbage_collection import SELDOM

    gc.set_threshold(SELDOM)  # as in the program itself: to look through all that is imported takes a tenth of a suite
    config.addinivalue_line("markers", "attack: takes minutes; only with --attack")
    config.addinivalue_line(
        "markers", "slow: takes over 1.5 CPU s, kills, waits, drives tools or attacks; not in `make test`"
    )
    if examples := config.getoption("attack"):
        if config.option.hypothesis_seed is None:
            config.option.hypothesis_seed = str(secrets.randbelow(2**32))
        usual = settings.get_profile("flockana")
        settings.register_profile("attack", usual, max_examples=examples, derandomize=False, print_blob=True)
        settings.load_profile("attack")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers(config):
    """One worker more than there are cores: tests of clusters, faults and limits mostly wait for what they started."""
    from flockana.ensemble.worker_processes import cores

    return cores() + 1


def _is_slow(path):
    """Whether all tests of a file or folder are slow."""
    return any(path.is_relative_to(Path(__file__).parent / name) for name in SLOW)


def pytest_ignore_collect(collection_path, config):
    """Import no file of slow tests where these are left out: each worker of `make test` would import them all."""
    return True if config.option.markexpr == "not slow" and _is_slow(collection_path) else None


def pytest_collection_finish(session):
    gc.freeze()  # what was collected is no garbage


def pytest_report_header(config):
    if examples := config.getoption("attack"):
        return f"attack: {examples} examples a test, --hypothesis-seed={config.option.hypothesis_seed}"
    return None


@pytest.hookimpl(tryfirst=True)  # before `-m` is read
def pytest_collection_modifyitems(config, items):
    for item in items:
        if _is_slow(item.path):
            item.add_marker("slow")
    if not config.getoption("attack"):
        items[:] = [item for item in items if item.get_closest_marker("attack") is None]


@pytest.fixture(scope="session")
def verdict_of():
    """The verdict of a theorem that needs no run, by its id: computed once, however many tests ask for it."""
    from flockana.theorems import verify

    return cache(verify)


@pytest.fixture(scope="module")
def browser():
    """Headless Chromium of the system's own packages; what asks for it is skipped where it or playwright lacks."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: flockana[browser]")
    names = "chromium", "chromium-browser", "google-chrome"
    if (chromium := next(filter(None, map(shutil.which, names)), None)) is None:
        pytest.skip("no Chromium on this machine: install the system's package chromium")
    with playwright.sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture
def open_tab(browser):
    """Open an address, in light or dark, wide or narrow; at the end no error was written to the console."""
    tabs, troubles = [], []

    def opened(address, *, dark=False, width=1280, quiet=True, offline=False, **options):
        scheme, size = "dark" if dark else "light", {"width": width, "height": 900}
        tab = browser.new_page(viewport=size, color_scheme=scheme, **options)
        tabs.append(tab)
        tab.set_default_timeout(120_000)  # milliseconds, on a busy machine
        if quiet:
            tab.on("pageerror", lambda error: troubles.append(str(error)))
            tab.on("console", lambda message: troubles.append(message.text) if message.type == "error" else None)
        if offline:
            tab.on("request", lambda asked: troubles.append(asked.url) if asked.url.startswith("http") else None)
        tab.goto(address)
        return tab

    yield opened
    for tab in tabs:
        tab.close()
    assert troubles == []


@pytest.fixture
def garbage_often_sought():
    """Garbage is sought as Python does by itself, not as seldom as tests have it: a change can be seen."""
    before = gc.get_threshold()
    gc.set_threshold(700, 10, 10)
    yield
    gc.set_threshold(*before)


@pytest.fixture
def answering():
    """Ctrl-C is answered here, even if whoever started the tests ignores it, which is inherited."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
