# Every target first makes the environment in .venv; see `make help`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
DESIGN ?= full
SET ?= thesis-chapter-5
WORKERS ?=
LOCKS := $(wildcard tools/requirements/py3*.txt)
# the solver runs one case a core: more threads inside a case only disturb the others
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
# some images forbid it: every command would then compile a thousand modules anew, 3 s each time
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help install campaign fit diagnose figures recordings proof verify test check docs hooks wheel bench lock clean

help: ## list the targets
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1\t/' | expand -t 12

install: $(STAMP) ## make .venv with the pinned packages and the command dentscope, check it, compile
	@bash tools/compile.sh

$(STAMP): pyproject.toml $(LOCKS) tools/install.sh
	@PYTHON="$(PYTHON)" bash tools/install.sh

campaign: $(STAMP) ## solve the finite-element cases of DESIGN into build/campaign; goes on where it stopped
	@$(BIN)/dentscope campaign run --design "$(DESIGN)" $(if $(WORKERS),--workers $(WORKERS))

fit: $(STAMP) ## fit the closed forms to the campaign: coefficients, standard errors, report in build/fit
	@$(BIN)/dentscope fit

diagnose: $(STAMP) ## say what physics is missing in SET (the thesis's oblique impacts), report in build/diagnose
	@$(BIN)/dentscope diagnose "$(SET)"

figures: $(STAMP) ## redraw the thesis's figures from our own numbers into docs/thesis
	@$(BIN)/dentscope figures

recordings: $(STAMP) ## fetch the raw recordings that may not be shipped, by address and checksum
	@$(BIN)/dentscope recordings fetch

proof: $(STAMP) ## conceal effects in made-up recordings, diagnose them blindly, score: hours, resumable
	@$(BIN)/dentscope proof run && $(BIN)/dentscope proof score

verify: $(STAMP) ## verify the solver anew where needed and write docs/verification.md: hours, resumable
	@$(BIN)/dentscope verify

test: $(STAMP) ## run the tests, docstring examples included
	@echo "tests: they may take 16 minutes on two cores, half of it for finite elements"
	@$(BIN)/python -m pytest -n auto --dist worksteal --durations=5

check: $(STAMP) ## lint, formatting, types, import order, size
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/mypy -p dentscope
	@$(BIN)/lint-imports
	@$(BIN)/python tools/ledger.py

docs: .venv-docs/.installed ## build the documentation site into build/docs; it needs no server and no network
	@$(BIN)/python tools/site/gather.py
	@NO_MKDOCS_2_WARNING=1 .venv-docs/bin/mkdocs build -q --strict -f build/mkdocs.yml
	@echo "docs: build/docs/index.html"

.venv-docs/.installed: $(STAMP) tools/requirements/docs.txt
	@$(BIN)/uv venv -q --clear --python $(BIN)/python .venv-docs
	@$(BIN)/uv pip install -q --python .venv-docs/bin/python --require-hashes -r tools/requirements/docs.txt
	@touch $@

hooks: $(STAMP) ## the other checks of a commit: blanks, ends of files, marks of a merge
	@if ! git rev-parse --git-dir >/dev/null 2>&1; then echo "hooks: no git repository here"; \
	  else SKIP=ruff,ruff-format,mypy,import-order $(BIN)/pre-commit run --all-files; fi

wheel: $(STAMP) ## build the package, install it elsewhere, use every command there once
	@$(BIN)/python tools/try_wheel.py

bench: $(STAMP) ## measure the speed of solver and impact, as ratios within one run
	@for file in tools/benchmarks/bench_*.py; do echo "== $$file"; $(BIN)/python $$file || exit 1; done

lock: $(STAMP) ## pin all packages anew for every supported Python
	@for minor in 11 12 13 14; do \
	  $(BIN)/uv pip compile -q pyproject.toml --extra dev --extra cluster --extra video --extra mocap --extra surface \
	    --extra tables --extra bayes --generate-hashes \
	    --python-version 3.$$minor --no-emit-index-url --no-header --no-annotate --upgrade \
	    -o tools/requirements/py3$$minor.txt; done
	@$(BIN)/uv pip compile -q --group docs --generate-hashes --universal \
	  --python-version 3.11 --no-emit-index-url --no-header --no-annotate --upgrade -o tools/requirements/docs.txt

clean: ## remove what was built; the environment and data/ stay
	@rm -rf build .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
