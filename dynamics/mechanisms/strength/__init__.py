"""Mechanisms that change the strength of the metal."""
