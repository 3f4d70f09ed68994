"""Errors, remarks and pictures of a blow: how sure its numbers are, what speaks against them."""
