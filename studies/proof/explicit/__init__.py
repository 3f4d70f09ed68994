"""Impacts computed by an explicit finite-element code of the proof alone."""
