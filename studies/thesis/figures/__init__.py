"""Stage figures: the thesis's figures and tables redrawn from our own numbers."""
