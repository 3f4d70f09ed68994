"""Studies of the closed forms: what their terms are worth, and their page in the docs."""
