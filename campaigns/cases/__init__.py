"""The cases that designs are made of: drawn, of the thesis, with hardening; and their pairs."""
