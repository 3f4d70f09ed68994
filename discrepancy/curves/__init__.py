"""Traces and profiles as numbers: one reduction for the recording, its noise and the simulation."""
