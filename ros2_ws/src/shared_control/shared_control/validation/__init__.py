"""The thesis' validation of kinematics, dynamics and control (2.2-2.4), redone."""
