"""Tasks that a person and a robot do together; one folder each."""
