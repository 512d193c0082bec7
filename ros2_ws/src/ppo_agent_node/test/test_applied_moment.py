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

"""What the agent takes for the moment that counted."""

import numpy as np
import pytest
from ppo_agent_node.applied_moment import AppliedMoment
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from shared_control_ros.wrenches import base_wrench

NOW_NS = 10**18
MS = 1_000_000


@pytest.fixture
def moment(observer):
    return AppliedMoment(observer.node, contract.HUMAN_APPLIED, (4,), contract.BASE_FRAME)


@pytest.fixture
def send(observer, moment):
    """Publish a moment, and wait until it is there to be taken."""
    publisher = observer.publisher(contract.HUMAN_APPLIED)
    observer.spin(lambda: publisher.get_subscription_count())

    def publish(stamp_ns, m_y, frame=contract.BASE_FRAME):
        wrench = base_wrench(frame)
        wrench.wrench.torque.y = m_y
        set_ns(wrench.header.stamp, stamp_ns)
        publisher.publish(wrench)
        publisher.wait_for_all_acked()
        observer.spin_for(0.05)

    return publish


class TestAppliedMoment:
    """One subscription for all, forgotten between tests."""

    @pytest.fixture(autouse=True)
    def afresh(self, moment):
        moment.clear()

    def test_the_newest_before_the_tick_counts(self, moment, send):
        send(NOW_NS, 5.0)
        send(NOW_NS + 10 * MS, -5.0)
        np.testing.assert_array_equal(moment.before(NOW_NS + 10 * MS), [5.0])
        np.testing.assert_array_equal(moment.before(NOW_NS + 20 * MS), [-5.0])

    def test_the_moment_of_a_silent_controller_counts_no_more(self, moment, send):
        send(NOW_NS, 5.0)
        np.testing.assert_array_equal(moment.before(NOW_NS + 100 * MS), [5.0])
        np.testing.assert_array_equal(moment.before(NOW_NS + 140 * MS), [0.0])

    def test_one_that_is_stamped_ahead_does_not_block_later_ones(self, moment, send):
        send(NOW_NS + 3600 * 1000 * MS, 5.0)
        send(NOW_NS + 10 * MS, -5.0)
        np.testing.assert_array_equal(moment.before(NOW_NS + 20 * MS), [-5.0])

    @pytest.mark.parametrize(('m_y', 'frame'), [(float('nan'), contract.BASE_FRAME), (5.0, 'world')])
    def test_unusable_ones_are_passed_over(self, moment, send, m_y, frame):
        send(NOW_NS, m_y, frame)
        send(NOW_NS + MS, -5.0)
        np.testing.assert_array_equal(moment.before(NOW_NS + 20 * MS), [-5.0])
