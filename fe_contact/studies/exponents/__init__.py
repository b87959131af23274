"""Exponents of contact: where they really lie, and what is read of them from impacts; study, files, charts."""
