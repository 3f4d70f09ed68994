"""The same contact problem for CalculiX: input deck, run, and reading of its output."""
