"""The page of the closed forms in the docs."""
