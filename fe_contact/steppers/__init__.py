"""One step of a striker on a body, and the surfaces that say how: of a half-space, fixed, of a flat end."""
