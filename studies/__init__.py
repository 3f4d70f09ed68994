"""Studies: what proves, verifies and redraws; run from a checkout, not shipped.

verification   the solver's checks, and the report that they make
proof          effects concealed in made-up recordings, diagnosed blindly, scored
third_world    the same by another simulator; peers: rules that the diagnosis has to beat
challenge      concealed sets for other people's methods
calibration    where truths lie in their posteriors: of prior draws, and (at_data) at recordings
interventions  known effects of real recordings concealed, diagnosed, judged by a plan
synthetic      rendered clips, markers, scans and sounds with a known truth
campaign       gallery, claims and trends of the finite-element campaign
closed_form    their page
oracle         a second integrator of impacts
thesis         the thesis again: figures, chapters 3 to 5
"""
