"""Time stepping, compiled: phases, motion, events, flights, and the record of an impact."""
