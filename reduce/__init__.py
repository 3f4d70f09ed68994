"""Stage reduce: from raw files of an instrument to trials with uncertainties."""
