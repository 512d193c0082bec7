"""Validation of the robot model and of the controller (chapter 2 of the thesis)."""
