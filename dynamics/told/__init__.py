"""What is said of a blow beside its numbers: how sure they are, and what speaks against them."""
