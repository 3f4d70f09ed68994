"""The proof: concealed impact recordings from generators that share nothing with the diagnosis.

Everything here imports only core and fem. `effects` and `truth` say what may be concealed, `benches`
and `rig` on what kind of rig, `dynamics` makes the impacts of the two fast families, `folder` writes
recording sets, `sample` writes a few of them to look at.
"""
