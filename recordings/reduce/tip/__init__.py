"""Photograph of a tip."""
