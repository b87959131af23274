"""Trade-offs of impacts with inertia, one target a file under the name it has in ``fe_contact.waves.targets``.

A member offers ``of(scene)``, what is tried of the body that moves: a module with ``variations(base, quick)``, settings
around the default's; ``exact(scene)``, the :class:`fe_contact.studies.tradeoff.truth.Truth` in closed form, None where
there is none; ``operations(work)``, the leading terms of the arithmetic behind the counted work; and ``forget()``,
which drops what is kept from one impact to the next.
"""
