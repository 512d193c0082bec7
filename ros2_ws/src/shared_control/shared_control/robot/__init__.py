"""Robots: what they can do, and their rigid-body model."""
