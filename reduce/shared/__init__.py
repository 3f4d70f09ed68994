"""What several instruments share: units, the part of a record that is used, fits."""
