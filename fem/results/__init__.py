"""What a solved path gives: forces and radii over it, fields, their uncertainty."""
