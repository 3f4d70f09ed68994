"""Stage recordings: measured impacts, reduced and checked."""
