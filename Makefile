# A fresh machine needs Python 3.10 or newer and make; each target below starts from a bare clone.
.PHONY: help setup demo test test-versions check check-newest check-oldest docs clean
.DEFAULT_GOAL := help

VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
# One more than there are cores: many tests wait for a robot, a process or a socket.
WORKERS := $(shell echo $$(( $$(nproc 2>/dev/null || echo 2) + 1 )))

help:
	@echo "make demo           set up, then two whole missions on built-in sites (results in out/)"
	@echo "make test           set up, then every test"
	@echo "make test-versions  set up, then the fast tests on every other Python at hand"
	@echo "make check          set up, then lint, types (Python, TypeScript), minimal versions, import rules"
	@echo "make docs           set up, then these pages as one site with search (build/docs)"
	@echo "make setup          the environment alone, in .venv"

setup: $(READY)

$(READY): pyproject.toml benchmarks/pyproject.toml constraints.txt scripts/setup.sh
	@sh scripts/setup.sh $(VENV)
	@touch $(READY)

demo: $(READY)
	@$(BIN)/fieldhand demo
	@$(BIN)/fieldhand demo mowing -o out/mowing

# The rewritten assertions of the tests are kept for the next run, also where Python is told to keep no bytecode.
test: $(READY)
	@$(BIN)/python scripts/build_page.py
	@env -u PYTHONDONTWRITEBYTECODE $(BIN)/python -m pytest -n $(WORKERS) --dist worksteal

# Seconds for all other releases of Python; what is not tested by then is named.
WITHIN := 600

test-versions: $(READY)
	@$(BIN)/python scripts/test_versions.py --within $(WITHIN)

# In two parts, which run at the same time with -j2.
check: check-newest check-oldest

check-newest: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

check-oldest: $(READY)
	$(BIN)/vermin --quiet --no-tips --eval-annotations -t=3.10- src benchmarks/src scripts tests examples ros2
	@# The installed stubs of numpy are for newer releases: here, some of their functions return Any.
	$(BIN)/mypy --python-version 3.10 --no-warn-return-any --no-warn-unused-ignores
	$(BIN)/python scripts/build_page.py --check

docs: $(READY)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[docs]"
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict

clean:
	rm -rf $(VENV) out build .mypy_cache .ruff_cache .pytest_cache .hypothesis
