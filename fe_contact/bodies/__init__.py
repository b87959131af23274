"""How contact sees a body: a free overlap and a compliance in, a pressure out, the state moved on.

``scaled_surface`` the homogeneous half-space: one operator, scaled to the contact radius of the instant;
``memory``         what the past of a viscoelastic surface adds;
``offer``          the contract of a body on a mesh that stays: ``surface_body`` where the surface alone remembers,
                   ``bulk_memory`` where volume and shape relax apart; ``sides`` of which ``stacked`` takes several;
                   ``chosen`` says which.
"""
