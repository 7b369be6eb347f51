"""What the commands of `lube` do: one module each."""
