"""Motion capture of markers."""
