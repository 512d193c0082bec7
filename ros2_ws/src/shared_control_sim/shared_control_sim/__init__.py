"""Simulated physics: worlds, an effort-controlled arm, and the plant in this process."""
