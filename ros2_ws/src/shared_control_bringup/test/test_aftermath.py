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

"""The test after the teaching is of the world that was taught in."""

import numpy as np
import pytest
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE
from shared_control_bringup import parameters
from shared_control_bringup.aftermath import plant_of
from shared_control_records.session.folder import SessionFolder
from shared_control_sim.local_plant import LocalPlant

OTHER_GAINS = next(name for name in panda().gains if name != 'task')


def end_of(plant):
    plant.reset(seed=0)
    for _ in range(20):
        plant.advance(np.array([3.0]))
    end = plant.world.ball_state()
    plant.close()
    return end


@pytest.mark.parametrize(('node', 'values'), [
    ('panda_sim_node', {'ball_mass': 1.0}), ('panda_sim_node', {'ball_radius': 0.04}),
    ('torque_ctrl_node', {'gains': OTHER_GAINS}), ('torque_ctrl_node', {'prediction_horizon': 0.02})])
def test_what_a_parameter_file_changes_is_changed_in_the_test(tmp_path, node, values):
    folder = SessionFolder(tmp_path)
    as_it_is = end_of(LocalPlant(BALANCE))
    assert end_of(plant_of(folder, BALANCE, 'bullet')) == as_it_is
    parameters.save(parameters.lay_over(parameters.load(), {node: values}), folder.parameters)
    assert end_of(plant_of(folder, BALANCE, 'bullet')) != as_it_is
