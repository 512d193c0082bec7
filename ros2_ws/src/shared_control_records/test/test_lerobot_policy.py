# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Policies of LeRobot, asked through a process: here one that speaks as lerobot_server.py does."""

import sys

import numpy as np
import pytest
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.plate import Plate
from shared_control_records.evaluation.lerobot_policy import LeRobotPolicy
from shared_control_records.evaluation.policies import load_policies
from shared_control_records.export.frames import action_rows


@pytest.fixture
def python(tmp_path):
    """A Python that answers with the sum of what was seen, as M_x and ten times that as M_y, and warns a lot."""
    script = tmp_path / 'python'
    script.write_text(f"""#!{sys.executable}
import json, sys
sys.stderr.write("a warning\\n" * 20_000)
if not sys.argv[2].endswith("good"):
    sys.exit("ValueError: no policy of that kind\\n")
print("ready", flush=True)
for line in sys.stdin:
    sys.stderr.write("a warning\\n" * 20_000)
    total = sum(json.loads(line))
    if total > 1000.0:
        sys.exit("OverflowError: too much")
    print(json.dumps([total, 10 * total]), flush=True)
""")
    script.chmod(0o755)
    for name in ('good', 'bad'):
        (tmp_path / name).mkdir()
        for file in ('config.json', 'model.safetensors'):
            (tmp_path / name / file).write_text('{}')
    return script


def test_moments_become_actions_along_the_axes_of_the_task(python, tmp_path):
    for task, expected in ((BALANCE, [10.0 / 8.0 * 0.5]), (Plate(), [0.5 / 8.0, 5.0 / 8.0])):
        policy = LeRobotPolicy(tmp_path / 'good', python, task)
        assert action_rows(task) == (3, 4)
        assert policy.act(np.array([0.25, 0.25], np.float32)) == pytest.approx(expected)
        assert policy.act(np.array([-9.0], np.float32))[-1] == -1.0
        policy.close()


def test_the_last_that_it_said_is_the_reason_why_there_is_no_answer(python, tmp_path):
    policy = LeRobotPolicy(tmp_path / 'good', python, BALANCE)
    with pytest.raises(ValueError, match=r'good: OverflowError: too much$'):
        policy.act(np.array([2000.0], np.float32))
    policy.close()


def test_what_cannot_be_used_is_named(python, tmp_path):
    with pytest.raises(ValueError, match=r'bad: ValueError: no policy of that kind'):
        load_policies([tmp_path / 'bad'], python, BALANCE)
    with pytest.raises(ValueError, match='--lerobot-python FILE says which Python'):
        load_policies([tmp_path / 'good'])
