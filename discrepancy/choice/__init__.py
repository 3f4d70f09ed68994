"""From evidence to a verdict: odds, pairs, what stands outside, what is said."""
