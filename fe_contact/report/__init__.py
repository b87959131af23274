"""Charts: the only package that imports matplotlib. Figures are made without pyplot and hold no global state."""
