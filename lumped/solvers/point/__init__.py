"""Two masses and a force law: the impact marched by collocation, its events located exactly.

The force of a solid that remembers, as of the 3-parameter solid, is ``HereditaryLoad.force`` in ``memory``.
"""
