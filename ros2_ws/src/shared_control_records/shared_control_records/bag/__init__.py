"""Bags: read back as arrays, and checked."""
