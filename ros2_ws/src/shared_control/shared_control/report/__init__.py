"""Reports: of a study, and of a session from its bag alone."""
