"""From evidence to a verdict: odds, pairs, what stands outside, thresholds and costs."""
