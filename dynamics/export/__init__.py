"""What other programs take of a pair: parameters of their contact laws, inputs, a formula."""
