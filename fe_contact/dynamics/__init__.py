"""Deformable bodies with inertia: matrices in, motion out; nothing here knows a geometry.

``body``      what moves: mass, stiffness with its memory, dashpots, gravity, where it may be pressed, and its state;
``mass/``     ways to put the mass on the nodes, one a file;
``schemes/``  time integrators as numbers, one a file;
``stepping``  what a step would do without new pressure, and how it yields to one;
``march``     the loop, written once, with what happens within a step, and where the energy goes.
"""
