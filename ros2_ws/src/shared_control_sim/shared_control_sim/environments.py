"""What ``gymnasium.make`` makes: a task's environment in this process."""

from typing import Any

from shared_control.env import SharedControlEnv
from shared_control.plugins import TASKS, load
from shared_control.teaching.tutors import make_tutor, tutor_named

from .local_plant import LocalPlant


def make_env(task: str, tutor: str | None = None, physics: str = 'bullet', human_only: bool = False,
             **settings: Any) -> SharedControlEnv:
    """The environment of the task called ``task``.

    Args:
        task: name (entry point of the group ``shared_control.tasks``).
        tutor: name of a simulated tutor (``expert``, ``crossover``, ...); nobody at the keys when None.
        physics: its name (entry point of the group ``shared_control.worlds``).
        human_only: the agent's moment is not applied.
        settings: of the task, as its class has them (``episode_seconds``, ``action_scale``, ...).

    Raises:
        ValueError: there is no task, profile or world of that name, a setting cannot be, or there is a tutor and
            the task has other axes than tutors know.
        TypeError: the task has no such setting.
        ImportError: the world is not installed; the message says what to install.
    """
    chosen = load(TASKS, task)(**settings)
    person = None if tutor is None else make_tutor(tutor_named(tutor), chosen)
    return SharedControlEnv(LocalPlant(chosen, person, physics), chosen, human_only)
