"""Time integrators as numbers, one a file; the march is written once, in :mod:`fe_contact.march.impact`.

Within a step the surface displacement is linear in time, so every branch of the relaxation modulus is
integrated exactly. A member offers

``ORDER``   order of accuracy in the step length;
``SAMPLE``  where in the step its force belongs, as a share of the step;
``LEVER``   displacement of a free mass by a constant force over a step, in units of ``force dt^2 / mass``;
``weights(moduli, ratios)``  for branches of modulus E_k and ratio x_k = dt/tau_k: their share of the step's
            stress per displacement increment, and their weight on the branch's own past.
"""
