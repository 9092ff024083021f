# The first interpreter that fits; name another one with `make PYTHON=...`.
FITS = import sys, venv, ensurepip; sys.exit(not (3, 11) <= sys.version_info < (3, 15))
PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$python -c '$(FITS)' 2>/dev/null && echo $$python && break; done)
BIN = .venv/bin
# pip says what it downloads, and shows how far it is.
PIP = $(BIN)/python -m pip --disable-pip-version-check
# What `make verify` needs, and the libraries of the tests, the docs and the site on top.
SOLVING = .venv/.solving
INSTALLED = .venv/.installed

.PHONY: help verify verify-all test test-all docs site test-site dist bench reports paper
.PHONY: release-data tradeoff engines satellite underwater causes check-reports lint types imports clean

help:  ## Print this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' Makefile

verify:  ## Run the standard set on all rungs, the extremes on f64; print the verdicts (to reports/local)
verify-all:  ## The same with the extremes on all rungs
verify-all: EXTREMES_ON = --rung f32 f64 f80 f128 mp237

# Bytecode is kept, whatever the shell says: else each process that starts compiles the package.
verify verify-all test test-all: export PYTHONDONTWRITEBYTECODE =

# Both are run, whatever the first one finds; an interrupt (130) ends both.
verify verify-all: $(SOLVING)
	@status=0; $(BIN)/taylor-verify run --out reports/local || status=$$?; \
		[ $$status -ne 130 ] || exit 130; \
		$(BIN)/taylor-verify run extremes $(EXTREMES_ON) --out reports/local/extremes && exit $$status

# What a file of tests shares is made once, in one process; tests/conftest.py says which files come first.
TESTS = $(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test: lint  ## Check style and types, then run all but the slow tests
	@$(TESTS) -m 'not slow'

test-all: lint  ## The same with the slow tests
	@$(TESTS)

docs: $(INSTALLED)  ## Build the pages of docs alone into docs/_build/html; a warning is an error
	@$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html
	@echo 'docs/_build/html/index.html'

# The first time in a clone this makes the data that the repository leaves out, and says so.
site: $(INSTALLED)  ## Make one site of docs and of all that is published, into reports/site
	@$(BIN)/taylor-verify publish --missing > /dev/null
	@$(BIN)/taylor-verify publish --site reports/site > /dev/null
	@echo 'reports/site/index.html'

# Beside the browser the small site of other tests is built, on the other core. A test that could not be run is a test that failed: without a browser this ends in an error.
test-site: site  ## Look at those pages in a browser without a window (Debian: installs chromium)
	@command -v chromium > /dev/null && command -v chromedriver > /dev/null || \
		{ apt-get --quiet update && apt-get --quiet --yes install chromium chromium-driver; }
	@$(TESTS) -m 'browser or slow' tests/site tests/studies/test_site.py

# Five minutes of one core at most.
bench: $(INSTALLED)  ## Take the costs in ratios: targets missed, changes since the last (KEEP=1 keeps them)
	@PYTHONPATH=tests $(BIN)/python -m benches $(ONLY) $(if $(KEEP),--keep) $(if $(STRICT),--strict)

# Each tool has an environment of its own, which uv makes and keeps.
dist: $(INSTALLED)  ## Build wheel and sdist into dist, and check what is in them and what they say
	@rm -f dist/taylor_verify-*
	@$(BIN)/python -m hatchling build -d dist
	@$(BIN)/uvx --quiet twine@7.0.0 check --strict dist/taylor_verify-*
	@$(BIN)/uvx --quiet check-wheel-contents@0.6.3 dist/taylor_verify-*.whl
	@$(BIN)/uvx --quiet pyroma@5.0.1 --min 8 dist/taylor_verify-*.tar.gz

reports: $(INSTALLED)  ## Rewrite what is published: reports/data, what is made from it, reports/reference and reports/claims.md
	@$(BIN)/taylor-verify publish controls hard > /dev/null
	@$(BIN)/taylor-verify run --out reports
	@$(BIN)/taylor-verify publish reference portraits enclosure claims > /dev/null

causes: $(INSTALLED)  ## Measure how often likely causes are right (COUNT=20 of each kind) to reports/local/causes.md
	@$(BIN)/taylor-verify publish causes --count $(or $(COUNT),20)

paper: $(INSTALLED)  ## Make the paper and its tables, PDF, LaTeX and CSV, in reports/paper
	@$(BIN)/taylor-verify publish --paper > /dev/null
	@echo 'reports/paper/paper.pdf'

# The paper is in the archive too; beside it, whoever wants to read need not unpack.
release-data: $(INSTALLED)  ## Pack everything published, what is not committed included, into dist
	@$(BIN)/taylor-verify publish --missing > /dev/null
	@$(BIN)/taylor-verify publish --paper > /dev/null
	@$(BIN)/taylor-verify publish --archive dist
	@cp reports/paper/paper.pdf dist/taylor-verify-paper.pdf

# Apart from the reports: a time is another one in every run, and nothing is ever compared with it.
tradeoff: $(INSTALLED)  ## Measure the published speed against accuracy anew, ours and others' (ten minutes, on a quiet machine)
	@$(BIN)/taylor-verify publish tradeoff --outside

# Each engine runs in an environment of its own, which is made when it is first asked for.
engines: $(INSTALLED)  ## Measure the engine board: what is not stored, or all of ENGINE=mujoco anew
satellite: $(INSTALLED)  ## Measure the satellite board likewise
underwater: $(INSTALLED)  ## Measure the underwater board likewise
engines satellite underwater:
	@$(BIN)/taylor-verify publish $@ $(if $(ENGINE),--anew --only $(ENGINE)) > /dev/null

# The rungs of hardware: they differ most between processors, and the wider ones take longer.
check-reports: $(SOLVING)  ## Run part of what is published anew: has a number left its rounding class?
	@$(BIN)/taylor-verify run --rung f32 f64 f80 --against reports

lint: $(INSTALLED)  ## Check style, types and who imports whom only
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(MAKE) --silent --jobs 2 types imports

types:
	@$(BIN)/mypy
imports:
	@$(BIN)/lint-imports --no-cache --no-logo

clean:  ## Remove the environment, the caches and the local reports
	rm -rf .venv .hypothesis .mypy_cache .pytest_cache .ruff_cache dist docs/_build reports/local reports/site
	find verify tests -name __pycache__ -type d -prune -exec rm -rf {} +

# A stamp is written last: an environment that was only half made has none, and is made again.
$(SOLVING): requirements-verify.txt pyproject.toml verify/taylor_verify/records/version.py
	@'$(PYTHON)' -c '$(FITS)' 2>/dev/null || { \
		found="$$('$(or $(PYTHON),python3)' --version 2>&1 | tail -n 1)"; \
		echo "expected Python 3.11 to 3.14 with venv (on Debian the package python3-venv)," \
			"got $$found; name another interpreter with make PYTHON=..." >&2; exit 2; }
	@echo 'setting up .venv (once): a download of 140 MB, 400 MB on disk, less than a minute on a fast line' >&2
	@rm -rf .venv
	@'$(PYTHON)' -m venv .venv
	@$(PIP) install --require-hashes -r requirements-verify.txt >&2
	@$(PIP) --quiet install --no-deps --no-build-isolation -e .
	@touch $@

$(INSTALLED): $(SOLVING) requirements.txt
	@echo 'adding the libraries of the tests, the docs and the site to .venv (once): 310 MB more to download, 1.8 GB on disk in all, one to three minutes' >&2
	@$(PIP) install --require-hashes -r requirements.txt >&2
	@touch $@
