"""How contact sees a body: a free overlap and a compliance in, a pressure out, the state moved on.

``scaled_surface`` the homogeneous half-space: one operator, scaled to the contact radius of the instant;
``memory``         what the past of a viscoelastic surface adds.
"""
