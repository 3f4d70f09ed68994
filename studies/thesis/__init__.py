"""The thesis again: its figures, its misprints, its forms, its chapters 3 to 5."""
