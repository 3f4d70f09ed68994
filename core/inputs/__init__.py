"""Reading what people write: TOML and JSON, with one line for each mistake."""
