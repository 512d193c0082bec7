"""Keyboard teleoperation: keys to the human moment M_yh, with a teaching screen in the terminal."""
