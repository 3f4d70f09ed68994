"""The compiled walk: phases, motion, events, flights, and the record of an impact."""
