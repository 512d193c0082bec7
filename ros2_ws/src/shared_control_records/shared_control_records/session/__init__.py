"""The folder of a session: final test, summary, picture, report."""
