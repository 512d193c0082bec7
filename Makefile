# Everything runs in an environment of its own, .venv/. `make help` lists the targets.
SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin
# The interpreter of the environment that is there, until another is asked for.
PYTHON ?= $(or $(wildcard $(BIN)/python),python3)
SRC := ros2_ws/src
MINUTES := 60
RUNS := 50
CHECK_SCHEMA := $(BIN)/check-jsonschema --quiet --builtin-schema
export OMP_NUM_THREADS := 1

.PHONY: help setup demo session test coverage lint lint-github docs links wheel bench bench-growth faults soak freeze flaky \
    pictures weight count colcon clean

help:
	@echo 'make demo     a session with a simulated tutor, then the robot alone (out/demo)'
	@echo 'make session  teach the robot yourself, from this terminal'
	@echo 'make test     all tests'
	@echo 'make coverage all tests, and which lines they ran; ARGS=PATH for a part of them'
	@echo 'make docs     the documentation as a site (out/docs/index.html)'
	@echo 'make links    whether the pages of others that ours link to are there (out/links/output.txt)'
	@echo 'make wheel    sdist and wheel (dist/), each installed and tried in an empty environment'
	@echo 'make lint     ruff, mypy, who may import whom, the linters of ROS, workflows and templates'
	@echo 'make bench    measurements (out/bench.json)'
	@echo 'make bench-growth  time and memory by length of session, readers, participants, sessions (out/growth)'
	@echo 'make faults   faults at random moments of live sessions, and what must hold in spite of them (out/faults.json)'
	@echo 'make soak     a long session, and whether anything grows; MINUTES=60 (out/soak.json)'
	@echo 'make freeze   a real-time loop beside a load, with the priorities that once froze it and with ours; MINUTES=60'
	@echo 'make flaky    the tests that ever failed by chance, RUNS=50 times'
	@echo 'make pictures the page in all its states, at five sizes (out/pictures)'
	@echo 'make weight   what installations weigh and how long pip takes; 15 minutes and 5 GB (out/install.json)'
	@echo 'make count    the size of the code, and what is tied to one task or robot, at the first version and now'
	@echo 'make colcon   colcon build and colcon test of the workspace'
	@echo 'make setup    the environment alone; PYTHON=python3.12 chooses another interpreter'
	@echo 'make clean    remove the environment and what was built'

setup: $(VENV)/ready

$(VENV)/ready: requirements.txt setup.py pyproject.toml $(wildcard $(SRC)/*/setup.py)
	@$(PYTHON) tools/check_machine.py
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --disable-pip-version-check --requirement requirements.txt
	@rm -rf shared_control.egg-info  # left by pip install . it would hide what the environment has
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation \
	    --editable . --editable $(SRC)/shared_control_testing
	@touch $@

demo: setup
	$(BIN)/shared-control session --tutor sim --profile expert --episodes 6 --output out/demo --overwrite

session: setup
	$(BIN)/shared-control session

test: setup
	@failed=0; \
	$(BIN)/python -m pytest -m 'not alone' --numprocesses 2 --dist loadscope --no-loadscope-reorder || failed=1; \
	$(BIN)/python -m pytest -m alone || failed=1; \
	exit $$failed

coverage: setup
	rm -f .coverage .coverage.*
	$(BIN)/python -m pytest -q --cov $(ARGS)
	$(BIN)/coverage report --skip-covered --sort=cover

docs: setup
	$(BIN)/python -m sphinx -b html --fail-on-warning --keep-going --quiet -d out/doctrees docs out/docs
	@echo 'out/docs/index.html'

links: setup
	$(BIN)/python -m sphinx -b linkcheck -C -D extensions=myst_parser -D root_doc=README -D suppress_warnings=myst,toc,misc \
	    -D include_patterns='*.md,docs/*.md,docs/*/*.md,examples/*/*.md,ros2_ws/src/*/README.md' \
	    --keep-going --quiet -d out/doctrees-links . out/links
	@echo 'out/links/output.txt'

wheel: setup
	$(BIN)/python tools/wheel.py --output dist

lint: setup
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	tools/ament.sh flake8 pep257
	$(MAKE) --no-print-directory lint-github

lint-github: setup
	$(BIN)/zizmor --offline --quiet .github
	$(CHECK_SCHEMA) vendor.github-workflows .github/workflows/*.yml
	$(CHECK_SCHEMA) vendor.github-issue-forms .github/ISSUE_TEMPLATE/fault.yml .github/ISSUE_TEMPLATE/idea.yml
	$(CHECK_SCHEMA) vendor.github-issue-config .github/ISSUE_TEMPLATE/config.yml
	$(CHECK_SCHEMA) vendor.dependabot .github/dependabot.yml
	$(CHECK_SCHEMA) vendor.citation-file-format CITATION.cff
	$(CHECK_SCHEMA) vendor.compose-spec docker/compose.yaml

count: setup
	$(BIN)/python tools/count.py $(ARGS)

pictures: setup
	$(BIN)/python tools/pictures.py out/pictures

weight: setup
	$(BIN)/python benchmarks/bench.py --only install --output out/install.json

bench: setup
	$(BIN)/python benchmarks/bench.py --output out/bench.json

bench-growth: setup
	$(BIN)/python benchmarks/growth.py $(ARGS)

faults: setup
	$(BIN)/python benchmarks/faults.py $(ARGS)

soak: setup
	$(BIN)/python benchmarks/soak.py --minutes $(MINUTES)

freeze: setup
	$(BIN)/python benchmarks/freeze.py --minutes $(MINUTES)

flaky: setup
	@for run in $$(seq $(RUNS)); do echo "run $$run of $(RUNS)"; \
	    $(BIN)/python -m pytest -q -m 'not alone' --maxfail=1 --numprocesses 2 --dist loadscope @tests/failed_by_chance.txt || exit 1; \
	    $(BIN)/python -m pytest -q -m alone --maxfail=1 @tests/failed_by_chance.txt || exit 1; done

colcon: setup
	PYTHON=$(BIN)/python tools/colcon.sh $(ARGS)

clean:
	rm -rf $(VENV) build shared_control.egg-info ros2_ws/build ros2_ws/install ros2_ws/log
