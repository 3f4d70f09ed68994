"""What stands in files: setups, sweeps, templates, rows of results."""
