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

"""Answers observations with a LeRobot policy's actions, a line of JSON each, on stdin and stdout.

Runs on the Python that lerobot is installed for, and needs nothing of this project: lerobot asks for other versions of
torch and Python than it does.

    python lerobot_server.py FOLDER        # a folder pretrained_model/ as lerobot-train leaves it
"""

import json
import sys
from pathlib import Path


def main(folder: str) -> None:
    """Serve until stdin ends."""
    import torch
    from lerobot.configs.policies import PreTrainedConfig
    from lerobot.policies.factory import get_policy_class, make_pre_post_processors
    torch.set_num_threads(1)
    config = PreTrainedConfig.from_pretrained(Path(folder))
    config.device = 'cpu'
    if hasattr(config, 'n_action_steps'):
        config.n_action_steps = 1  # an answer to every observation, none from a queue of an earlier episode
    policy = get_policy_class(config.type).from_pretrained(folder, config=config)
    policy.eval()
    before, after = make_pre_post_processors(
        config, pretrained_path=folder, preprocessor_overrides={'device_processor': {'device': 'cpu'}})
    print('ready', file=OUTPUT, flush=True)
    for line in sys.stdin:
        observation = torch.tensor([json.loads(line)], dtype=torch.float32)
        batch = before(dict.fromkeys(config.input_features, observation))
        with torch.inference_mode():
            policy.reset()
            action = after(policy.select_action(batch))
        print(json.dumps(action.reshape(-1).tolist()), file=OUTPUT, flush=True)


if __name__ == '__main__':
    OUTPUT, sys.stdout = sys.stdout, sys.stderr  # libraries print, too
    main(sys.argv[1])
