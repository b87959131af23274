"""Bodies that yield, without inertia: pressed, released, and struck."""
