"""Generators of truths and of the recordings that hold them; they share nothing with the tool."""
