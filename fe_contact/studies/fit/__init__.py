"""A fitted law: its chart."""
