# Needs Python 3.10 or newer, make and git; everything else goes into .venv.
PYTHON ?= python3
BIN := .venv/bin
OUT := out

# Matrices are small: threads below numpy only cost.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: help study test docs clean

help:
	@echo "make study   the default study into $(OUT)/study.nc and $(OUT)/study.html"
	@echo "make test    lint, types, tests"
	@echo "make docs    the documentation into $(OUT)/docs"
	@echo "make clean   removes .venv, $(OUT) and caches"

study: .venv/installed
	@mkdir -p $(OUT)
	$(BIN)/rover-pin study -o $(OUT)/study.nc --html $(OUT)/study.html $(if $(wildcard $(OUT)/study.nc.parts),--resume)
	@echo "result: $(CURDIR)/$(OUT)/study.nc"
	@echo "page:   $(CURDIR)/$(OUT)/study.html (open it in a browser)"

test: .venv/installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest -q -n 2

docs: .venv/installed-docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict
	@echo "pages: $(CURDIR)/$(OUT)/docs/index.html (open it in a browser)"

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10) and "Python 3.10 or newer is needed: make PYTHON=/path/to/python3")'
	$(PYTHON) -m venv .venv

# Editable, so that a change of the code counts at once; only a change of pyproject.toml installs anew.
.venv/installed: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install -q -e .
	@touch $@

.venv/installed-test: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install -q -e '.[test,lint]'
	@touch .venv/installed $@

.venv/installed-docs: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install -q -e '.[docs]'
	@touch .venv/installed $@

clean:
	rm -rf .venv $(OUT) dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
