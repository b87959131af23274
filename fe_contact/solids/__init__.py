"""Bodies that are not linear: solved whole by Newton's method, contact on the deformed or the undeformed surface."""
