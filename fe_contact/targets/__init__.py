"""Support and body of each target, one a file under the name it has in ``lumped.targets`` and ``meshes``.

A member offers ``surface(poisson, numerics)``: what contact sees of the body.
"""
