"""Campaign: the claims of chapter 2 decided, trends over the pairs."""
