"""Judgement: what finite elements say of every lumped law, and what accuracy costs by every method."""
