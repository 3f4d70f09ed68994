"""A world that shares no rule with the program: concealed sets to try the diagnosis on.

Dents that are off finite elements by some per cent, as real metals are, and own equations of
motion. `contact` has the law, `physics` what acts in a blow, `motion` the blows, `effects` what may
be missing, `benches` the rigs, `draw` a set, `sheet` its files; `studies.proof.third_world` runs
it.
"""
