"""The proof: concealed impact recordings from generators that share nothing with the diagnosis.

Everything here imports only core and fem. `effects` and `truth` say what may be concealed,
`benches` and `rig` on what kind of rig; `dynamics` makes the impacts of the two families; `folder`
writes recording sets. `lists`, `run`, `seal`, `score` and `page` are the protocol: draw, seal,
diagnose, seal, open, count, publish.
"""
