"""The live graph and the environment in this process go through the same states, bit for bit."""

import numpy as np
import pytest
from ppo_agent_node.graph_plant import GraphPlant
from shared_control.env import SharedControlEnv
from shared_control.rates import TICKS_PER_ACTION
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from shared_control_ros.stamps import to_ns
from shared_control_sim.local_plant import LocalPlant

SEED = 11
STEPS = 750


def actions():
    """Smooth and abrupt ones, around the moment that keeps the tray level, so that the ball stays on it."""
    random = np.random.default_rng(SEED)
    steps = np.arange(STEPS)
    return -0.26 + 0.15 * np.sin(steps / 9) + 0.3 * random.choice([-1, 0, 1], STEPS)


@pytest.fixture
def local():
    """The in-process environment, and a list of (q, qd, effort) that grows with every tick."""
    plant, ticks = LocalPlant(), []
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
def graph(start_node, observer):
    """The same on the unpaced graph."""
    states = observer.listen(contract.JOINT_STATES)
    start_node('panda_sim_node', paced=False)
    start_node('torque_ctrl_node', enabled=True, wait_for=['agent'])
    background = Background(observer.node)
    plant = GraphPlant(observer.node, background, observer.take_all)
    plant.wait_until_up()
    env = SharedControlEnv(plant)
    yield env, states
    env.close()
    background.close()


def test_an_episode_on_the_graph_equals_one_in_process(local, graph, observer):
    (local_env, local_ticks), (graph_env, states) = local, graph
    for episode_seed, steps in ((SEED, STEPS), (SEED + 1, 50)):  # a second one: nothing of the first remains
        local_ticks.clear()
        local_rows, graph_rows = [], []
        for env, rows in ((local_env, local_rows), (graph_env, graph_rows)):
            rows.append(env.reset(seed=episode_seed)[0])
        first_stamp = graph_env.plant._stamp_ns
        for action in actions()[:steps]:
            for env, rows in ((local_env, local_rows), (graph_env, graph_rows)):
                observation, reward, terminated, truncated, info = env.step(np.array([action], np.float32))
                rows.append([*observation, reward, terminated, truncated, info['applied'][0],
                             *info['reward_terms'].values()])
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
