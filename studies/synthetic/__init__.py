"""Raw files rendered with a known truth, to prove a reduction or to plan a measurement."""
