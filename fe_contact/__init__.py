"""Finite-element reference histories of impact, with error bars; comparison with every lumped law.

>>> import fe_contact, lumped
>>> scene = lumped.Scene.load("polymer-sphere")
>>> reference = fe_contact.run(scene, tolerance=1e-3)      # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lumped import Result, Scene

__all__ = ["run"]
__version__ = "0.1.0"


def run(
    scene: Scene,
    tolerance: float | None = None,
    method: str | None = None,
    numerics: Mapping[str, Any] | None = None,
) -> Result:
    """One impact.

    Parameters
    ----------
    scene : a :class:`lumped.Scene`.
    tolerance : asked of every ruled quantity; None leaves it to ``numerics`` or the default 1e-3.
    method : ``fe``, ``cheapest`` or the name of a lumped law; None: the law the scene names, else ``fe``.
    numerics : settings to keep, as in the ``[numerics]`` table of a scene file. A scene is physics alone: the table of
        the file it was loaded from is read by the command line only, and has to be given here.

    Raises
    ------
    BadInput for what cannot be used, NotReached where no march came to an end.
    """
    from fe_contact.methods import simulate
    from fe_contact.threads import one_thread

    with one_thread:
        return simulate(scene, method, numerics or {}, tolerance)
