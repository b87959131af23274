"""Time integrators as numbers, one a file: each offers ``of(rho)``, the :class:`~.base.Scheme` whose spectral radius
for infinitely fast oscillations is ``rho``, as far as the family leaves a choice.
"""
