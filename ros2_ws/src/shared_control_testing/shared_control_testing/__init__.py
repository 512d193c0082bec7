"""Fixtures and made-up recordings for the tests of the other packages."""
