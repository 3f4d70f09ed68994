"""A body that bounces: its flights, its contacts, its speeds."""
