# Everything runs in an environment of its own, .venv/. `make help` lists the targets.
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
SRC := ros2_ws/src
# In the order of their dependencies.
PACKAGES := panda_tray_description shared_control shared_control_ros panda_sim_node torque_ctrl_node teleop_key_node \
            mock_panda_node panda_bridge_node \
            ppo_agent_node sim_tutor_node session_recorder_node robot_view_node teach_page_node shared_control_bringup
export OMP_NUM_THREADS := 1

.PHONY: help setup demo session test lint bench colcon clean

help:
	@echo 'make demo     a session with a simulated tutor, then the robot alone (out/demo)'
	@echo 'make session  teach the robot yourself, from this terminal'
	@echo 'make test     all tests'
	@echo 'make lint     ruff and mypy'
	@echo 'make bench    measurements (out/bench.json)'
	@echo 'make colcon   colcon build and colcon test of the workspace'
	@echo 'make setup    the environment alone; PYTHON=python3.12 chooses another interpreter'
	@echo 'make clean    remove the environment and what was built'

setup: $(VENV)/ready

$(VENV)/ready: requirements.txt $(foreach p,$(PACKAGES),$(SRC)/$(p)/setup.py)
	@$(PYTHON) tools/check_machine.py
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --disable-pip-version-check --requirement requirements.txt
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation \
	    $(foreach p,$(PACKAGES),--editable $(SRC)/$(p))
	@touch $@

demo: setup
	$(BIN)/shared-control session --tutor sim --profile expert --episodes 6 --output out/demo --overwrite

session: setup
	$(BIN)/shared-control session

test: setup
	$(BIN)/python -m pytest -m 'not alone' --numprocesses 2 --dist loadscope --no-loadscope-reorder
	$(BIN)/python -m pytest -m alone

lint: setup
	$(BIN)/ruff check .
	$(BIN)/mypy

bench: setup
	$(BIN)/python benchmarks/bench.py --output out/bench.json

colcon: setup
	PYTHON=$(BIN)/python tools/colcon.sh $(ARGS)

clean:
	rm -rf $(VENV) ros2_ws/build ros2_ws/install ros2_ws/log
