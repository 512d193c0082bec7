"""Which node publishes, hears, serves and calls what: who is to be allowed what on a secured graph."""

from dataclasses import dataclass

from . import contract
from .contract import Topic

SET_PARAMETERS = 'panda_sim_node/set_parameters'
DISPLAYED = (
    contract.JOINT_STATES_THROTTLE, contract.BALL, contract.HUMAN_WRENCH, contract.AGENT_WRENCH,
    contract.APPLIED_WRENCH)
ROBOT = (contract.JOINT_STATES, contract.JOINT_STATES_THROTTLE, contract.DIAGNOSTICS)


@dataclass(frozen=True)
class Interface:
    """What one node does beside what every node does (its log, its parameters, the clock).

    Names are relative to the namespace; ``~`` is the node's own.
    """

    publishes: tuple[Topic | str, ...] = ()
    hears: tuple[Topic | str, ...] = ()
    serves: tuple[str, ...] = ()
    calls: tuple[str, ...] = ()


INTERFACES = {
    'panda_sim_node': Interface(
        publishes=(*ROBOT, contract.BALL, contract.CLOCK),
        hears=(contract.EFFORT_COMMANDS, contract.DISTURBANCE),
        serves=('~/reset', '~/pause')),
    'mock_panda_node': Interface(
        publishes=(*ROBOT, contract.BALL, contract.CLOCK),
        hears=(contract.EFFORT_COMMANDS, contract.DISTURBANCE),
        serves=('~/reset', '~/pause', '~/error_recovery')),
    'panda_bridge_node': Interface(
        publishes=ROBOT, hears=(contract.EFFORT_COMMANDS,), serves=('~/enable', '~/error_recovery')),
    'torque_ctrl_node': Interface(
        publishes=(contract.EFFORT_COMMANDS, contract.APPLIED_WRENCH, contract.DIAGNOSTICS),
        hears=(contract.JOINT_STATES, contract.HUMAN_WRENCH, contract.AGENT_WRENCH, contract.EMERGENCY_STOP),
        serves=('~/enable', '~/emergency_stop', '~/reset_emergency_stop')),
    'teleop_key_node': Interface(
        publishes=(contract.HUMAN_WRENCH, contract.KEYS, contract.DIAGNOSTICS),
        hears=(contract.KEYS, *DISPLAYED, *contract.TRAINING),
        calls=(contract.PAUSE_SERVICE, contract.FINISH_SERVICE)),
    'ppo_agent_node': Interface(
        publishes=(contract.AGENT_WRENCH, contract.DIAGNOSTICS, *contract.TRAINING),
        hears=(contract.BALL, contract.JOINT_STATES_THROTTLE, contract.HUMAN_WRENCH, contract.APPLIED_WRENCH),
        serves=('~/finish', '~/start', '~/repeat'),
        calls=(contract.RESET_SERVICE, contract.PAUSE_SERVICE, SET_PARAMETERS)),
    'sim_tutor_node': Interface(
        publishes=(contract.KEYS, contract.DIAGNOSTICS),
        hears=(contract.BALL, contract.JOINT_STATES_THROTTLE, contract.HUMAN_WRENCH, contract.EPISODE,
               contract.PHASE)),
    'teach_page_node': Interface(
        publishes=(contract.KEYS,),
        hears=(contract.KEYS, *DISPLAYED, *contract.TRAINING),
        calls=(contract.PAUSE_SERVICE, contract.FINISH_SERVICE, contract.START_SERVICE, contract.REPEAT_SERVICE)),
    'session_recorder_node': Interface(publishes=(contract.DIAGNOSTICS,), hears=contract.BAG_TOPICS),
    'robot_view_node': Interface(
        publishes=('robot_description', 'markers', '/tf', contract.DIAGNOSTICS), hears=DISPLAYED),
    'operator': Interface(
        publishes=(contract.EMERGENCY_STOP, contract.DISTURBANCE),
        hears=contract.TOPICS,
        calls=('torque_ctrl_node/enable', 'torque_ctrl_node/emergency_stop', 'torque_ctrl_node/reset_emergency_stop',
               'panda_bridge_node/enable', 'panda_bridge_node/error_recovery', 'mock_panda_node/error_recovery',
               contract.RESET_SERVICE, contract.PAUSE_SERVICE, contract.FINISH_SERVICE)),
}
"""By name of the node; ``operator`` is a person with the ros2 command."""
