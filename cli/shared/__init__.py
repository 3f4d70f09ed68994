"""What the commands share: groups, keys, places of files, the terminal."""
