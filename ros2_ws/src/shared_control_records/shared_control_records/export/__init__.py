"""Bags as data sets for others' tools."""
