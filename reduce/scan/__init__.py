"""Scan of a crater or a ball."""
