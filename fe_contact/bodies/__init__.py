"""How contact sees a body: a free overlap and a compliance in, a pressure out, the state moved on.

``memory``    what the past of a viscoelastic surface adds;
``offer``     the contract of a body on a mesh that stays: in ``memory`` where the surface alone remembers,
              ``bulk_memory`` where volume and shape relax apart, by ``modes``;
``pressing``  bodies at rest, and where their contacts may end; ``bar`` a body with mass in one dimension.
"""
