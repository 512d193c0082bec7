"""Which extra of the distribution brings a module that is not installed."""

_EXTRAS = {
    'gymnasium': 'sim', 'pybullet': 'sim', 'mujoco': 'mujoco', 'shared_control_sim': 'sim',
    'torch': 'learn', 'stable_baselines3': 'learn', 'safetensors': 'learn', 'pydantic': 'learn', 'tensorboard': 'learn',
    'tqdm': 'learn', 'shared_control_learning': 'learn',
    'pandas': 'study', 'matplotlib': 'study', 'scipy': 'study', 'mcap': 'study', 'rosbags': 'study',
    'shared_control_records': 'study', 'rclpy': 'ros', 'nicegui': 'page',
}


def missing(what: str, error: ModuleNotFoundError) -> ImportError:
    """The error for something that cannot be loaded because ``error`` was raised: it says what to install."""
    module = (error.name or '').partition('.')[0]
    advice = f': pip install "shared-control[{_EXTRAS[module]}]"' if module in _EXTRAS else ''
    return ImportError(f'{what} needs the module {module!r}, which is not installed{advice}', name=error.name)
