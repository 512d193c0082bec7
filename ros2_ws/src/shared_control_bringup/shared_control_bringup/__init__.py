"""Starts the whole graph and keeps what a session leaves behind."""
