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

"""What goes to the browser is JSON, whatever came in."""

import json

import numpy as np
import pytest
from shared_control_ros.watching.scene import Parts
from teach_page_node.history import History
from teach_page_node.picture import Picture

NAN, INF = float('nan'), float('inf')


def refuse(constant):
    raise AssertionError(f'{constant} is no JSON')


@pytest.mark.parametrize('picture', [
    Picture(silent_for=INF), Picture(parts=Parts((INF,), (-INF,), (NAN,))), Picture(success=NAN, human_share=NAN),
    Picture(q=np.array([NAN] + 6 * [0.0]), ball=np.full(3, INF), ball_on_tray=np.full(3, NAN), pitch=NAN),
    Picture(time_left=INF, time=NAN)])
def test_what_is_not_finite_is_left_out(picture):
    message = json.loads(json.dumps(picture.message()), parse_constant=refuse)
    assert {key for key, value in message.items() if value is not None} <= {
        'keys', 'hand', 'paused', 'notice', 'time', 'ends_teaching', 'rests_left', 'verdict'}


def test_finite_numbers_are_rounded():
    assert Picture(ball=np.array([0.12345, 0.0, 1.0]), success=0.95).message()['ball'] == [0.1235, 0.0, 1.0]
    assert Picture(success=0.95).message()['success'] == 0.95


def test_the_history_too():
    history = History()
    history.add(NAN, INF)
    history.add(-12.3, None)
    assert history.message() == {'returns': [None, -12.3], 'shares': [None, None]}
