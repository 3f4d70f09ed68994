"""Stage discrepancy: what physics is missing in a simulation that recordings do not match."""
