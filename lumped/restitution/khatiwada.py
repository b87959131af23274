"""Khatiwada, Chouw and Butterworth 2014, Eng. Struct. 62-63, 33-41: F = k depth^n + c depth^n depth'.

The generic law in the form which section 2.5 of the source paper gives to it: that of Hunt and Crossley with a free
exponent n, its damping "numerically exact" instead of one of the published approximations. The exact relation does
not depend on n, so it is that of Hunt and Crossley with d = c v_0/k. Both exits are one.
"""

from lumped.restitution.base import Family, formulas
from lumped.restitution.hunt_crossley import damping, restitution

MEMBER = Family(restitution, damping, formulas())
