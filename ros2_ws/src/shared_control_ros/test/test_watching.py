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

"""What screens make of the topics of a lesson, however seldom they look."""

import pytest
from shared_control_ros import contract
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.watching.observer import Observer
from shared_control_ros.watching.pause import Pause
from shared_control_ros.watching.requests import Requests
from shared_control_ros.watching.scene import Scene
from std_msgs.msg import Float64, Int32, String
from std_srvs.srv import Trigger

BREAK = (2.9, 2.8)


class Agent:
    """Publishes as the agent does, and has a screen that looks when it is told to."""

    def __init__(self, observer):
        self._publishers = {topic.name: observer.publisher(topic) for topic in (
            contract.PHASE, contract.EPISODE, contract.TIME_LEFT, contract.EPISODE_RETURN)}
        self.node, self.wait, self.wait_for = observer.node, observer.spin, observer.spin_for
        self.screen = self.new_screen()

    def new_screen(self):
        """One that comes now."""
        lesson, watcher, scene = Lesson(self.node), Observer(self.node), Scene()

        def look():
            lesson.update()
            scene.phase, scene.episode, scene.began_ns = lesson.phase, lesson.episode, lesson.began_ns
            watcher.update(scene)
            return scene
        self.wait(lambda: all(publisher.get_subscription_count() for publisher in self._publishers.values()))
        return look

    def enter(self, phase):
        self._publishers[contract.PHASE.name].publish(String(data=phase))

    def begin(self, phase, episode, *left):
        self.enter(phase)
        self._publishers[contract.EPISODE.name].publish(Int32(data=episode))
        self.count_down(*left)

    def end(self, *left):
        self._publishers[contract.EPISODE_RETURN.name].publish(Float64(data=-1.0))
        self.enter('learn')
        self.count_down(*left)

    def count_down(self, *left):
        for seconds in left:
            self._publishers[contract.TIME_LEFT.name].publish(Float64(data=seconds))

    def shown(self, screen=None, **expected):
        """The scene, once it is as expected."""
        look = screen or self.screen
        self.wait(lambda: all(getattr(look(), name) == value for name, value in expected.items()), what=str(expected))
        return look()


@pytest.fixture
def agent(observer):
    agent = Agent(observer)
    agent.enter('wait')
    agent.shown(phase='wait')
    return agent


@pytest.mark.parametrize(('left', 'words'), [
    ((3.0, 2.9, 0.1, 0.0), 'The ball was kept for 3 s'), ((3.0, 2.9, 2.0), 'The ball fell after 1 s')])
@pytest.mark.parametrize('looks_often', [True, False])
def test_the_outcome_tells_the_length_that_the_agent_uses(agent, left, words, looks_often):
    agent.count_down(*BREAK, 0.0)
    if looks_often:
        agent.shown(next_in=0.0)
    agent.begin('teach', 1, left[0])
    for seconds in left[1:]:
        if looks_often:
            agent.shown(phase='teach')
        agent.count_down(seconds)
    assert agent.shown(phase='teach', time_left=left[-1]).episode_seconds == 3.0
    agent.end(*BREAK)
    assert agent.shown(phase='learn', next_in=2.8).outcome.words.startswith(words)


def test_the_last_of_an_episode_is_its_own_when_it_comes_with_the_phase_after_it(agent):
    agent.begin('teach', 1, 15.0)
    assert agent.shown(time_left=15.0).episode_seconds == 15.0
    agent.count_down(0.1, 0.0)
    agent.end(*BREAK)
    scene = agent.shown(phase='learn', next_in=2.8)
    assert scene.time_left == 0.0
    assert scene.outcome.words.startswith('The ball was kept for 15 s')


def test_each_episode_has_its_own_length(agent):
    agent.begin('teach', 1, 3.0, 2.9)
    assert agent.shown(time_left=2.9).episode_seconds == 3.0
    agent.end(*BREAK)
    agent.begin('test', 1, 10.0, 9.9)
    assert agent.shown(phase='test', time_left=9.9).episode_seconds == 10.0


def test_who_comes_in_the_middle_of_an_episode_takes_the_length_of_the_task(agent):
    agent.begin('teach', 1, 3.0)
    agent.shown(time_left=3.0)
    agent.wait_for(0.7)
    agent.count_down(2.3)
    late = agent.new_screen()
    assert agent.shown(late, phase='teach', time_left=2.3).episode_seconds == 15.0
    assert agent.shown(phase='teach', time_left=2.3).episode_seconds == 3.0


def test_the_end_that_was_asked_for_is_shown_until_the_teaching_is_over(observer):
    requests = Requests(observer.node, lambda _: None, Pause(observer.node))
    observer.node.create_service(Trigger, contract.FINISH_SERVICE, lambda _, response: Trigger.Response(success=True))
    observer.node.create_service(Trigger, contract.KEEP_TEACHING_SERVICE, lambda _, response: response)  # refuses

    def ask(to, what):
        observer.spin(lambda: to() or requests.is_pending, what='the learner is there')
        observer.spin(lambda: not requests.is_pending, what=what)
    ask(requests.finish, 'it ends')
    for phase in ('teach', 'wait', 'teach', 'learn', None):
        requests.follow(phase, 0)
        assert requests.ending, 'a void episode begins anew after a while'
    ask(requests.keep_teaching, 'it has been started anew, and was not to end')
    assert not requests.ending
    ask(requests.finish, 'it ends')
    requests.follow('test', 0)
    assert not requests.ending
