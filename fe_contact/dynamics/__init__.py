"""Deformable bodies with inertia: matrices in, motion out; nothing here knows a geometry.

``body``      what moves: mass, stiffness with its memory, dashpots, gravity, and where it may be pressed;
``mass/``     ways to put the mass on the nodes, one a file;
``schemes/``  time integrators as numbers, one a file;
``implicit``, ``explicit``  what a step would do without new pressure, and how it yields to one;
``march``     the loop, written once;
``ledger``    where the energy goes, each term computed on its own;
``stages``    parts of a step of central difference;
``events``    first touch and separation within a step.
"""
