"""Commands of the workshop: `cli.studies` adds them to the command line of a checkout."""
