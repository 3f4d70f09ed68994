"""What is compared: conditions, their measured cells, and what the simulation says of them."""
