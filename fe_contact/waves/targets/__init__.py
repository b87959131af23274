"""Impacts with inertia, one target a file under the name it has in ``lumped.targets``.

A member offers ``plan(scene, given)``, the settings chosen, ``cost(scene, numerics)``, what an error budget with them
takes, and ``fe(scene, given, progress)``, the certified Result.
"""
