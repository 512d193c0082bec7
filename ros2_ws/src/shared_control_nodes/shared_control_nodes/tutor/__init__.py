"""Simulated tutor: watches the ball and presses keys, as a person would."""
