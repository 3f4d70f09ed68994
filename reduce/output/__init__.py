"""What a reduction leaves behind: rows of a recording set, its record and picture."""
