"""What comes after the teaching: the test of the policy alone, the report, a word to the person."""

import json

from shared_control.envs.balance_env import BalanceEnv
from shared_control.envs.local_plant import LocalPlant
from shared_control.learning.evaluate import evaluate, test_settings
from shared_control.learning.policy_file import load_policy, read_description
from shared_control.session.folder import SessionFolder
