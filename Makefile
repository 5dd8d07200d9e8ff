# Everything lives in .venv; each target sets up what it needs. PYTHON chooses the interpreter (3.11 or newer).
PYTHON ?= python3
BIN := .venv/bin

.PHONY: verify test check bench proofs notebooks course clean

verify: .venv/.installed  ## run the catalogue, check every theorem, write report/index.html
	$(BIN)/flockana verify

test: .venv/.dev  ## the whole test suite
	$(BIN)/python -m pytest -n auto

check: .venv/.dev  ## format, lint, types, import direction
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python tools/import_lint.py

bench: .venv/.dev  ## ratios against baselines
	$(BIN)/python -m pytest benchmarks --benchmark-only -p no:xdist

proofs: .venv/.dev  ## run every executable proof
	$(BIN)/python -m proofs

notebooks: .venv/.dev  ## execute every notebook with its solutions
	$(BIN)/python tools/run_notebooks.py

course: .venv/.dev  ## write course/student and course/solutions as .ipynb
	$(BIN)/python tools/course.py

.venv/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "flockana needs Python 3.11 or newer: make PYTHON=python3.12 ...")'
	$(PYTHON) -m venv .venv

.venv/.installed: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

.venv/.dev: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@ .venv/.installed

clean:
	rm -rf .venv report
