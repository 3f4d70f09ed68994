"""Commands of the workshop, `studies/`: they lie in a checkout and are not installed.

`..studies` adds them to the command line where they are present.
"""
