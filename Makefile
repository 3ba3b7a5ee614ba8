# `make run` and `make test` need Python >= 3.11 and make, nothing else.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
OUT    ?= out

.DEFAULT_GOAL := help

help:  ## list the targets
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 12

install: $(BIN)/.installed  ## create .venv and install wedgesweep with its test tools

$(BIN)/.installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	PYTHONWARNINGS='ignore:Editable installation' $(BIN)/python -m pip install --quiet --editable '.[test]'
	touch $@
	@echo "first runs compile for half a minute; $(BIN)/wedgesweep warm-up does that ahead"

run: install  ## run configs/quick.toml; dataset and figures in out/
	mkdir -p $(OUT)
	$(BIN)/wedgesweep run configs/quick.toml --fresh -o $(OUT)/quick.nc
	$(BIN)/wedgesweep plot all $(OUT)/quick.nc -o $(OUT)/quick-figures

test: install  ## the tests
	$(BIN)/python -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder

acceptance: install  ## full searches, rare combinations, the slow solver (see the marks in pyproject.toml)
	$(BIN)/python -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder -m acceptance

lint: install  ## linter and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

check: lint test acceptance  ## linter, types and all tests

reproduce: install  ## run the paper's 1,800 cases and check its claims
	PYTHONPATH=scripts $(BIN)/python -m reproduce -o $(OUT)/reproduction

validate: install  ## hide effects in data, diagnose them, compare with the truth (hours; rerun to resume)
	$(BIN)/python -m pytest -q tests/validation/diagnoses.py
	PYTHONPATH=scripts $(BIN)/python -m validation --output $(OUT)/validation $(if $(ABLATE),--ablate "$(ABLATE)")

everywhere:  ## the tests in eight surroundings: locale, home, user, versions, ... (half an hour)
	scripts/everywhere.sh

torture: install  ## 100,000 hostile inputs, 10,000 files of each of 16 formats and 200 kills (hours)
	$(BIN)/python scripts/fuzz.py
	$(BIN)/python scripts/fuzz.py --formats --inputs 160000
	$(BIN)/python scripts/kill_campaign.py

bench: install  ## benchmarks, as ratios within one run
	for script in scripts/bench_*.py; do $(BIN)/python $$script || exit 1; done

clean:  ## remove everything that the other targets made
	rm -rf $(VENV) $(OUT) build dist *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis .kernels

.PHONY: help install run test acceptance lint check reproduce validate everywhere torture bench clean
