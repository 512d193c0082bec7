"""Names of the topics of a session, as a bag has them (docs/architecture.md; types and QoS: shared_control_ros)."""

JOINT_STATES = '/joint_states'
EFFORT_COMMANDS = '/effort_controller/commands'
KEYS = '/human/keys'
HUMAN_WRENCH = '/human/target_wrench'
AGENT_WRENCH = '/agent/target_wrench'
APPLIED_WRENCH = '/target_wrench'
BALL = '/ball'
DISTURBANCE = '/disturbance'
EMERGENCY_STOP = '/emergency_stop'
DIAGNOSTICS = '/diagnostics'
CLOCK = '/clock'
EPISODE = '/training/episode'
PHASE = '/training/phase'
TIME_LEFT = '/training/time_left'
EPISODE_RETURN = '/training/episode_return'
HUMAN_SHARE = '/training/human_share'
SUCCESS = '/training/success'

TRAINING = (EPISODE, PHASE, TIME_LEFT, EPISODE_RETURN, HUMAN_SHARE, SUCCESS)
TOPICS = (JOINT_STATES, EFFORT_COMMANDS, KEYS, HUMAN_WRENCH, AGENT_WRENCH, APPLIED_WRENCH, BALL, DISTURBANCE,
          EMERGENCY_STOP, DIAGNOSTICS, CLOCK, *TRAINING)
"""Every topic of the contract."""

BASE_FRAME = 'panda_link0'
