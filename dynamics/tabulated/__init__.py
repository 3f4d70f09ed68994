"""A pair's law and its energy as tables: quick forces, and impacts without steps."""
