"""Tests of a policy: randomised (4.2), with pushes (4.3), on a moving tray (4.6)."""
