# Everything here needs Python 3.11 or newer with pip, and nothing else: each target makes what it misses in .venv.
# Another interpreter: make demo PYTHON=python3.12. All combinations: make test TESTS="not slow"

PYTHON ?= python3
BIN := .venv/bin
TESTS ?= not slow and not grid
PIP := $(BIN)/python -m pip install --disable-pip-version-check --no-input -qq

.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help demo test test-random test-studio check docs package bench judges figures clean

help: ## what can be made, a line each
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-11s %s\n", $$1, $$2 }' Makefile

demo: .venv/.with-core ## the paper's problem solved and its Figure 2 redrawn, into out/
	$(BIN)/nullpose compare examples/paper.toml
	$(BIN)/nullpose reproduce --out out

# with bytecode on disk, programs that tests start begin sooner
test test-random: export PYTHONDONTWRITEBYTECODE =

test: .venv/.with-test ## the tests, on two processes
	$(BIN)/pytest -n 2 --dist worksteal -m "$(TESTS)"

test-random: .venv/.with-test ## property tests on new examples, which a failure prints, and the large sizes
	$(BIN)/pytest -n 2 --dist worksteal --hypothesis-profile random -m "hypothesis or grid or slow"

test-studio: .venv/.with-studiotest ## the studio's page, in Chromium, and who is let in, on two processes
	@command -v chromium > /dev/null || { test "$$(id -u)" = 0 && command -v apt-get > /dev/null && apt-get update -qq && apt-get install -y -qq --no-install-recommends chromium > /dev/null; } || { echo "Chromium is not on the path. Debian has it: apt install chromium"; exit 1; }
	$(BIN)/pytest -n 2 --dist loadfile tests/studio/browser/studio_*.py

check: .venv/.with-lint ## lint, format, spelling, types and the import contract
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell README.md CHANGELOG.md CONTRIBUTING.md benchmarks docs examples src
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: .venv/.with-docs ## the documentation, warnings being errors, into docs/_build/html
	$(BIN)/sphinx-build -q -E -W --keep-going -n -b html docs docs/_build/html
	@echo "Open docs/_build/html/index.html in a browser; it needs no network."

package: .venv/.made ## a wheel and a source archive, tried outside the clone in an environment of their own
	$(PIP) build
	.ci/package $(BIN)/python out/package

bench: .venv/.with-bench ## the benchmark and its report, docs/benchmarks.md
	$(BIN)/python -m benchmarks --page

judges: .venv/.with-core ## other engines on the same links, and what they say, docs/judges.md
	@command -v nec2c > /dev/null || { test "$$(id -u)" = 0 && apt-get update -qq && apt-get install -y -qq nec2c libllvm19 > /dev/null; } || echo "nec2c and libllvm19 are not installed: their judges are skipped"
	@$(MAKE) --no-print-directory .venv/.with-judges || echo "Sionna RT cannot be installed here: it is skipped"
	$(BIN)/python -m benchmarks.judges

figures: .venv/.with-core ## the pictures and the claims that README and pages show, made anew
	$(BIN)/python docs/make_figures.py
	$(BIN)/python docs/figures/certificate_boxes.py
	$(BIN)/python docs/figures/proof_boxes.py
	$(BIN)/python docs/figures/logo.py
	$(BIN)/python docs/figures/cards.py
	$(BIN)/python docs/figures/airframes_data.py
	$(BIN)/python docs/figures/airframes.py
	$(BIN)/python docs/figures/objectives_data.py
	$(BIN)/python docs/figures/objectives.py
	$(BIN)/python docs/figures/channels.py
	$(BIN)/python docs/figures/least_tilt.py

clean: ## take away .venv, out and docs/_build
	rm -rf .venv out docs/_build

# The environment: made once, and brought up to date whenever pyproject.toml changes.

.venv/.made:
	@command -v $(PYTHON) > /dev/null || { echo "$(PYTHON) is not on the path. Install Python 3.11 or newer, or name one: make PYTHON=/path/to/python3"; exit 1; }
	@$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11))" || { echo "nullpose needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1). Name a newer one: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c "import ensurepip, venv" 2> /dev/null || { echo "$(PYTHON) lacks its venv module. Debian and Ubuntu pack it apart: apt install python3-venv"; exit 1; }
	@echo "Making the environment in .venv (once, about a minute)"
	@if [ -e .venv ] && ! $(BIN)/python -c "" 2> /dev/null; then rm -rf .venv; fi
	@$(PYTHON) -m venv .venv
	@touch $@

.venv/.with-core: pyproject.toml .venv/.made
	@echo "Installing nullpose and its dependencies into .venv"
	@$(PIP) -e .
	@touch $@

.venv/.with-%: .venv/.with-core
	@echo "Installing the $* tools into .venv"
	@$(PIP) -e '.[$*]'
	@touch $@
