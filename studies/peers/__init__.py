"""Simple rules on the very problem that a diagnosis has: what its own decision must beat.

The forward model, the grids of the mechanisms, the cells and the stated numbers are the
diagnosis's; what is left out are its errors of law and form, nulls, outliers and nameless physics.
`fitted` fits a set once for all rules, `rules` declares them, `compare` runs them over a folder of
sets; `studies.proof.rivals` counts what they say against the truths.
"""
