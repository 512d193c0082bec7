"""What of a lesson or a recording people are shown."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Showing:
    """What a page shows, besides what moves."""

    feedback: str = 'full'
    """One of :data:`shared_control.teaching.feedback.FEEDBACK`."""
    in_session: bool = False
    """A lesson is about to be given: nothing known of it means that it starts."""
    shows_result: bool = True
    """Whether test, picture and report are shown in the end."""
    title: str = ''
    """Which recording this is."""
    marks: tuple[tuple[float, str, str], ...] = ()
    """Where its episodes begin, s, their names, and a person's verdicts."""
    tested: str = ''
    """What the robot alone came to in the test of the recorded session."""
