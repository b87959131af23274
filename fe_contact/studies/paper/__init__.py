"""The paper recomputed: files, charts."""
