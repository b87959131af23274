"""Laws with memory in internal variables, by collocation. Everything inside is without dimension.

Time is counted in elastic contact times T, velocity in that of touch v, depth in v T, force in m v/T.
"""
