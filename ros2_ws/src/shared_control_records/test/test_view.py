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

"""What of a session is logged to Rerun, read back from the file."""

import numpy as np
import pytest
from shared_control import contract
from shared_control.cli import main
from shared_control.robot.model import RobotModel, quaternion_of
from shared_control_records.bag import recover
from shared_control_records.bag.reader import read_bag
from shared_control_testing import rosbag2
from shared_control_testing import sessions as made

pytest.importorskip('rerun', reason='an extra of 490 MB: pip install "shared-control[view]"')


@pytest.fixture(scope='module')
def own(tmp_path_factory):
    return made.record([made.lesson(50), made.lesson(50, seed=1)]).write(tmp_path_factory.mktemp('made') / 'bag')


@pytest.fixture
def view(monkeypatch, tmp_path):
    """``view(bag)``: columns by entity and component, of what changes with time."""
    from rerun.chunk import RrdReader

    def view(bag):
        file = tmp_path / 'session.rrd'
        monkeypatch.setattr('sys.argv', ['shared-control', 'view', str(bag), '--output', str(file)])
        assert main() == 0
        found = {}
        for chunk in RrdReader(str(file)).stream().to_chunks():
            if not chunk.is_static:
                batch = chunk.to_record_batch()
                for name in batch.schema.names[1:]:
                    found.setdefault((chunk.entity_path, name), []).extend(batch.column(name).to_pylist())
        return found
    return view


def scalars(found, entity):
    return np.array(found[entity, 'Scalars:scalars'], float).ravel()


def test_arm_ball_moments_phases_and_keys_are_those_of_the_bag(own, view):
    bag, found, model = read_bag(own), view(own), RobotModel()
    tray, ball = (np.array(found[f'/world/{what}', 'Transform3D:translation'], float)[:, 0]
                  for what in ('tray', 'ball'))
    where, rotation = model.tray_pose(bag.joint_states.q[0])
    assert tray[0] == pytest.approx(where, abs=1e-6) and 98 <= len(tray) <= 102
    turned = np.array(found['/world/tray', 'Transform3D:quaternion'], float)[0, 0]
    assert abs(turned @ quaternion_of(rotation)) == pytest.approx(1.0, abs=1e-6)
    assert ball == pytest.approx(bag.ball.position, abs=1e-6)
    assert {f'/world/arm/panda_link{number}_0' for number in range(8)} <= {entity for entity, _ in found}
    for who, wrenches in (('human', bag.human_applied), ('agent', bag.agent_applied), ('applied', bag.applied)):
        assert scalars(found, f'/moments/m_y/{who}') == pytest.approx(wrenches.moment[:, 0])
    assert scalars(found, '/training/episode_return') == pytest.approx(bag.training[contract.EPISODE_RETURN].values)
    assert len(scalars(found, '/ball/position_error')) > 100
    assert found['/log/phase', 'TextLog:text'] == [['teach'], ['teach']]
    assert len(found['/log/keys', 'TextLog:text']) == len(bag.presses) > 0


def test_one_time_line_from_the_start_of_the_bag(own, view):
    bag, found = read_bag(own), view(own)
    for entity, times in found.items():
        if entity[1] == 'time':
            assert all(0 <= time.total_seconds() <= (bag.end_ns - bag.start_ns) * 1e-9 + 1e-6 for time in times), entity
    assert ('/world/ball', 'time') in found


@pytest.mark.parametrize('form', [
    {'compression': 'file'}, {'rename': lambda topic: topic if topic == '/clock' else f'/robot1{topic}'},
    {'qos': False}])
def test_converted_namespaced_and_foreign_bags_are_shown_as_our_own(own, view, tmp_path, form):
    assert view(rosbag2.convert(own, tmp_path / 'other', **form)) == view(own)


def test_a_killed_bag_is_shown_when_it_is_finished(own, tmp_path, view, monkeypatch, capsys):
    bag = rosbag2.convert(own, tmp_path / 'other')
    path, = bag.glob('*.mcap')
    path.write_bytes(path.read_bytes()[:path.stat().st_size * 2 // 3])
    monkeypatch.setattr('sys.argv', ['shared-control', 'view', str(bag), '--output', str(tmp_path / 'x.rrd')])
    assert main() == 2
    assert 'shared-control recover' in capsys.readouterr().err
    recover(bag)
    assert len(view(bag)['/world/ball', 'time']) > 20


def test_a_bag_without_parts_shows_what_was_asked_for(own, tmp_path, view):
    parts = (contract.HUMAN_APPLIED, contract.AGENT_APPLIED)
    bag = made.record([made.lesson(50)]).write(tmp_path / 'bag', without=parts)
    assert scalars(view(bag), '/moments/m_y/human') == pytest.approx(read_bag(bag).human.moment[:, 0])
