"""Accuracy against cost: study, front, files, charts."""
