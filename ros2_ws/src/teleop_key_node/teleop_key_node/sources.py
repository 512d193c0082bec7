"""From the keys of several sources to one M_yh."""

from collections.abc import Sequence

from shared_control.keys import KeyMoment, KeyPresses


class KeySources:
    """Hears any number of sources of keys; none of them can leave a moment behind.

    Args:
        moment: what the presses change.
        timeout: a source that pressed and is silent for longer takes the moment with it, s.
    """

    def __init__(self, moment: KeyMoment, timeout: float):
        self._moment = moment
        self._timeout_ns = round(timeout * 1e9)
        self._presses: dict[str, KeyPresses] = {}
        self._heard_ns: dict[str, int] = {}
        self._holding: set[str] = set()
        self._is_active = True
        self.last_pressed = ''
        """The source of the latest press."""

    @property
    def m_y(self) -> float:
        """M_yh, N m."""
        return float(self._moment.moment[0])

    @property
    def is_active(self) -> bool:
        """Whether presses count. The moment is zero while they do not."""
        return self._is_active

    @is_active.setter
    def is_active(self, active: bool) -> None:
        self._is_active = active
        if not active:
            self.release()

    def hear(self, source: str, buttons: Sequence[int], now_ns: int) -> None:
        """The button states of one source, heard at ``now_ns``.

        Raises:
            ValueError: these are no states of three buttons.
        """
        presses = self._presses.setdefault(source, KeyPresses()).update(buttons)
        self._heard_ns[source] = now_ns
        if not self._is_active:
            return
        for key in presses:
            self._moment.press(key)
            self._holding.add(source)
            self.last_pressed = source
        if not self._moment.moment.any():
            self._holding.clear()

    def drop_silent(self, now_ns: int) -> list[str]:
        """Forget the sources that fell silent; the names of those whose moment was thereby set to zero.

        A clock that jumped back (a simulator started anew) makes every source silent.
        """
        silent = [name for name, heard in self._heard_ns.items() if not 0 <= now_ns - heard <= self._timeout_ns]
        for name in silent:
            del self._heard_ns[name], self._presses[name]
        gone = [name for name in silent if name in self._holding]
        if gone:
            self.release()
        return gone

    def release(self) -> None:
        """M_yh = 0. A key that is held down at this moment counts again when it is pressed again."""
        self._moment.release()
        self._holding.clear()
