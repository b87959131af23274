"""The paper's own examples: what it gives, and what the laws make of it."""
