"""What the metals do: yield, flow laws, and what they make of an impact."""
