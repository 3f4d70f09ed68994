"""Stage models: closed-form contact laws behind one contract."""
