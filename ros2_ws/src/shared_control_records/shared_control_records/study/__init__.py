"""Studies: participants x conditions, simulated or real, from one YAML file."""
