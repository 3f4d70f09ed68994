"""The processes and streams of a command: children, interruptions, output that is closed."""
