"""Starts the whole graph: parameter file, launch files, sessions."""
