"""Stage fitting: closed forms fitted to a campaign."""
