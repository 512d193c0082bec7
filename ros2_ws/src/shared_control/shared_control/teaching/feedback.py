"""What a person is told while they teach, besides what they see of tray, ball and their own push."""

FEEDBACK = ('none', 'ball', 'full')
"""``none``: nothing. ``ball``: how each episode ended. ``full``: and the robot's push, human share, score and tests."""
