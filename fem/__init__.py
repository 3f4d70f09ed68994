"""Stage fem: mesh and finite-strain contact solve of a sphere and a flat."""
