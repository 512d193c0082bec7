"""What is learned and how, by name."""

from dataclasses import dataclass, replace

from ..task.settings import DEFAULT_TASK, THESIS_TASK, TaskSettings


@dataclass(frozen=True)
class PpoSettings:
    """Settings of PPO (Schulman et al., 2017) with one update an episode.

    The defaults are the design's (section 4).
    """

    hidden: tuple[int, ...] = (32, 32)
    """Units of the hidden layers (tanh), of policy and value function each."""
    initial_std: float = 0.6
    """Of the policy, in units of the action."""
    learning_rate: float = 1e-3
    epochs: int = 10
    batch_size: int = 125
    gamma: float = 0.99
    gae_lambda: float = 0.95
    clip_range: float = 0.2
    entropy_weight: float = 0.0
    value_weight: float = 0.5
    max_gradient_norm: float = 0.5


@dataclass(frozen=True)
class CoachingSettings:
    """How a correction teaches the policy (design, section 4)."""

    gain: float = 2.0
    """g: how far a correction of a full action's moment moves the label, in units of the action."""
    delay: float = 0.25
    """d: how long after the robot's action people press, s."""
    weight: float = 1.0
    """lambda in the first episode."""
    fade_episodes: int = 8
    """The episode from which on lambda is 0; it falls linearly until then."""

    def weight_in(self, episode: int) -> float:
        """lambda in ``episode`` (from 1)."""
        return self.weight * max(0.0, 1.0 - (episode - 1) / self.fade_episodes)


@dataclass(frozen=True)
class Preset:
    """A task and a way to learn it."""

    name: str
    task: TaskSettings
    ppo: PpoSettings
    coaching: CoachingSettings | None = None
    """None: PPO is told nothing of the human."""


PRESETS: dict[str, Preset] = {preset.name: preset for preset in (
    Preset('coached', DEFAULT_TASK, PpoSettings(), CoachingSettings()),
    Preset('thesis', THESIS_TASK, replace(PpoSettings(), initial_std=1.0, learning_rate=3e-4, batch_size=64)),
    Preset('autonomous', DEFAULT_TASK, PpoSettings()),
)}
"""``coached``: corrections are labels, too. ``thesis``: the human's moment is a part of the environment and nothing
else (3.3, 3.4); the text gives no settings of PPO, so they are those of Stable-Baselines3. ``autonomous``: no human."""


def preset(name: str) -> Preset:
    """The preset called ``name``.

    Raises:
        ValueError: there is none; the message lists the names.
    """
    if name not in PRESETS:
        raise ValueError(f'no preset {name!r}; there are {", ".join(PRESETS)}')
    return PRESETS[name]
