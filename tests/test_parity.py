"""The live graph and the environment in this process go through the same states, bit for bit."""

import numpy as np
import pytest
from ppo_agent_node.graph_plant import GraphPlant
from shared_control.env import SharedControlEnv
from shared_control.rates import TICKS_PER_ACTION
from shared_control.tasks.balance import BALANCE
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from shared_control_ros.stamps import set_ns, to_ns
from shared_control_ros.wrenches import base_wrench, set_moment
from shared_control_sim.local_plant import LocalPlant

SEED = 11
STEPS = 750


def actions():
    """Smooth ones, around the moment that keeps the tray level, so that the ball stays on it."""
    return -0.26 + 0.15 * np.sin(np.arange(STEPS) / 9)


def moments():
    """Those of the person: abrupt ones, N m."""
    return 2.4 * np.random.default_rng(SEED).choice([-1.0, 0.0, 1.0], (STEPS, 1))


class Script:
    """A person who gives a moment, (1,), N m, at every policy tick."""

    held = np.zeros(1)

    def reset(self, seed):
        pass

    def moment(self, state):
        return self.held


@pytest.fixture(scope='module', params=['bullet', 'mujoco'])
def physics(request):
    return request.param


@pytest.fixture
def person():
    return Script()


@pytest.fixture
def local(person, physics):
    """The in-process environment, and a list of (q, qd, effort) that grows with every tick."""
    plant, ticks = LocalPlant(person=person, physics=physics), []
    step = plant.world.step

    def recorded_step(torque):
        q, qd = plant.world.joint_state()
        ticks.append(np.concatenate([q, qd, plant.world.effort]))
        step(torque)

    plant.world.step = recorded_step
    env = SharedControlEnv(plant)
    yield env, ticks
    env.close()


@pytest.fixture
def graph(start_node, observer, person, physics):
    """The same on the unpaced graph."""
    states = observer.listen(contract.JOINT_STATES)
    start_node('panda_sim_node', paced=False, physics=physics)
    start_node('torque_ctrl_node', enabled=True, wait_for=['human', 'agent'])
    background = Background(observer.node)
    publisher, wrench = observer.publisher(contract.HUMAN_WRENCH), base_wrench()

    def attend():
        """The person answers every observation, as the agent does."""
        observer.take_all()
        set_ns(wrench.header.stamp, plant._stamp_ns)
        set_moment(wrench, person.held)
        publisher.publish(wrench)

    plant = GraphPlant(observer.node, BALANCE.axes, background, attend)
    plant.wait_until_up()
    env = SharedControlEnv(plant)
    yield env, states
    env.close()
    background.close()


def test_an_episode_on_the_graph_equals_one_in_process(local, graph, observer, person):
    (local_env, local_ticks), (graph_env, states) = local, graph
    for episode_seed, steps in ((SEED, STEPS), (SEED + 1, 50)):  # a second one: nothing of the first remains
        local_ticks.clear()
        local_rows, graph_rows = [], []
        for env, rows in ((local_env, local_rows), (graph_env, graph_rows)):
            rows.append(env.reset(seed=episode_seed)[0])
        first_stamp = graph_env.plant._stamp_ns
        for action, person.held in list(zip(actions(), moments(), strict=True))[:steps]:
            for env, rows in ((local_env, local_rows), (graph_env, graph_rows)):
                observation, reward, terminated, truncated, info = env.step(np.array([action], np.float32))
                rows.append([*observation, reward, terminated, truncated, *info['human'], *info['agent'],
                             *info['applied'], *info['reward_terms'].values()])
            if terminated:
                break
        assert not terminated, 'the test wants a whole episode'
        np.testing.assert_array_equal(local_rows[0], graph_rows[0])
        np.testing.assert_array_equal(local_rows[1:], graph_rows[1:])

        last_stamp = first_stamp + len(local_ticks) * 1_000_000
        observer.spin(lambda end=last_stamp: states and to_ns(states[-1].header.stamp) >= end)
        # By stamp: a tick that waits for the agent for long is published again.
        graph_ticks = {to_ns(m.header.stamp): [*m.position, *m.velocity, *m.effort] for m in states}
        stamps = range(first_stamp, last_stamp, 1_000_000)
        assert len(stamps) == steps * TICKS_PER_ACTION
        np.testing.assert_array_equal(local_ticks, [graph_ticks[stamp] for stamp in stamps])
