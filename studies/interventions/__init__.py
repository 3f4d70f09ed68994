"""Known effects of real recordings, concealed, and what the diagnosis then says.

plan           the pairs with their statements of a fair verdict, from data/interventions/plan.toml
bases          the recordings as sets: shipped ones, and those made from fetched raw files
edits          what a side of a pair leaves out, states otherwise or turns
told           each set diagnosed once, judged by the plan, and the page docs/interventions.md
"""
