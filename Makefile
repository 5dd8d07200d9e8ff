# Everything lives in .venv; each target sets up what it needs. PYTHON chooses the interpreter (3.11 or newer), TESTS
# what `lowest` and `newest` run, NAME what `wheel` verifies, OPTIONS goes to `portability`, `mutation`, `bench`, `docs`.
PYTHON ?= python3
BIN := .venv/bin
TESTS ?=
NAME ?= hexagon

.PHONY: verify test test-all attack check bench proofs notebooks course coverage docs portability mutation lowest newest wheel clean

verify: .venv/.installed  ## run the catalogue, check every theorem, write report/index.html
	$(BIN)/flockana verify

test: .venv/.dev  ## formulas, theorems, laws, numbers and commands, in five minutes on two cores
	$(BIN)/python -m pytest -n auto --dist worksteal -m "not slow"

test-all: .venv/.dev  ## the whole test suite, with what takes longer, kills processes, waits, drives tools, certifies and attacks
	$(BIN)/python -m pytest -n auto --dist worksteal

attack: .venv/.dev  ## attack the verdicts with thousands of new cases, for hours; ATTACK=N examples a test
	$(BIN)/python -m pytest tests/adversarial --attack=$(or $(ATTACK),2000) -n 2

check: .venv/.dev  ## format, lint, types, import direction, names in compiled code, coverage and errata
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python tools/import_lint.py
	$(BIN)/python tools/rebinding_lint.py
	$(BIN)/python tools/name_lint.py
	$(BIN)/python -m tools.coverage_page --check
	$(BIN)/python -m tools.errata_page --check

bench: .venv/.dev  ## measure everything, write report/performance; OPTIONS="--quick" or "--out docs"
	$(BIN)/python -m benchmarks $(OPTIONS)

proofs: .venv/.dev  ## run every executable proof
	$(BIN)/python -m proofs

notebooks: wheel .venv/.dev  ## execute every notebook as it is delivered, where only the wheel is installed
	$(BIN)/python tools/run_notebooks.py --wheel

course: .venv/.dev  ## write course/student and course/solutions as .ipynb, unless a file there was changed
	$(BIN)/flockana course course/student
	$(BIN)/flockana course course/solutions --solutions

coverage: .venv/.dev  ## write docs/coverage.md and docs/errata.md from their tables
	$(BIN)/python -m tools.coverage_page
	$(BIN)/python -m tools.errata_page

docs: .venv/.docs  ## build the site, site/html/index.html; OPTIONS="--draft" executes nothing, "--external" checks outer links
	$(BIN)/python -m tools.site $(OPTIONS)

portability: .venv/.installed  ## which verdicts change on other machine code, from moved starts, at other tolerances
	$(BIN)/python -m tools.portability $(OPTIONS)

mutation: .venv/.dev  ## change the code in small ways and see which changes no test notices; OPTIONS="--sample 200 laws"
	$(BIN)/python -m tools.mutation $(OPTIONS)

lowest:  ## the tests with every dependency at its lower bound, in an environment of their own
	$(call environment,.venv-lowest)
	$(PYTHON) tools/dependencies.py > .venv-lowest/constraints.txt
	$(call tested,.venv-lowest,--constraint .venv-lowest/constraints.txt)

newest:  ## the tests with every dependency as new as it is today; PYTHON=python3.13 for another Python
	$(call environment,.venv-newest)
	$(call tested,.venv-newest,)

wheel:  ## build sdist and wheel into dist, and verify NAME with the installed wheel, in a folder without the sources
	$(call environment,.venv-wheel)
	.venv-wheel/bin/python -m pip install --quiet --disable-pip-version-check build twine
	rm -rf dist
	.venv-wheel/bin/python -m build --outdir dist
	.venv-wheel/bin/python -m twine check --strict dist/*
	$(call environment,.venv-wheel)
	.venv-wheel/bin/python -m pip install --quiet --disable-pip-version-check dist/*.whl
	away=$$(mktemp -d) && cd "$$away" && unset PYTHONPATH && "$(CURDIR)"/.venv-wheel/bin/flockana verify $(NAME) \
		&& "$(CURDIR)"/.venv-wheel/bin/python -c 'import flockana, sys; sys.exit("site-packages" not in flockana.__file__)' \
		&& rm -r "$$away"

# numba keeps what it compiles beside the sources, for one of its versions: other versions have a folder of their own
define tested
	$(1)/bin/python -m pip install --quiet --disable-pip-version-check $(2) --editable '.[test,cluster,proofs]'
	$(1)/bin/python -m pip list --disable-pip-version-check
	NUMBA_CACHE_DIR=$(CURDIR)/$(1)/numba $(1)/bin/python -m pytest -n auto -p no:cacheprovider $(TESTS)
endef

define environment
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "flockana needs Python 3.11 or newer: make PYTHON=python3.12 ...")'
	$(PYTHON) -m venv --clear $(1)
endef

.venv/bin/python:
	$(call environment,.venv)

.venv/.installed: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

.venv/.dev: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@ .venv/.installed

.venv/.docs: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	touch $@ .venv/.installed

clean:
	rm -rf .venv .venv-lowest .venv-newest .venv-wheel dist report site docs/generated
