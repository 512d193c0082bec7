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

"""Which extra of the distribution brings a module that is not installed."""

_EXTRAS = {
    'gymnasium': 'sim', 'pybullet': 'sim', 'mujoco': 'mujoco', 'shared_control_sim': 'sim',
    'torch': 'learn', 'stable_baselines3': 'learn', 'safetensors': 'learn', 'pydantic': 'learn', 'tqdm': 'learn',
    'shared_control_learning': 'learn', 'tensorboard': 'tensorboard',
    'pandas': 'study', 'matplotlib': 'study', 'scipy': 'study', 'mcap': 'study', 'rosbags': 'study',
    'shared_control_records': 'study', 'pyarrow': 'export', 'rclpy': 'ros', 'nicegui': 'page',
}


class NotInstalled(ImportError):
    """Something is not installed; the message says what, and what brings it."""


def missing(what: str, error: ModuleNotFoundError) -> NotInstalled:
    """The error for something that cannot be loaded because ``error`` was raised: it says what to install."""
    module = (error.name or '').partition('.')[0]
    advice = f': pip install "shared-control[{_EXTRAS[module]}]"' if module in _EXTRAS else ''
    return NotInstalled(f'{what} needs the module {module!r}, which is not installed{advice}', name=error.name)
