"""Ways to put an element's mass on its nodes, one a file: each offers ``of(local, dofs, size, contact)``.

``local`` (e, k, k) consistent mass of every element, kg, ``dofs`` (e, k) their nodes among ``size``, ``contact`` (c,)
the nodes that may touch. The answer is sparse (size, size); its total is the body's mass.
"""
