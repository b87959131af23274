"""The method that a target with waves takes by itself, as a witness of any other: two methods have one limit."""

from __future__ import annotations

from collections.abc import Mapping

from fe_contact.waves.numerics import WaveNumerics


def witness(numerics: WaveNumerics, usual: Mapping[str, str]) -> dict[str, WaveNumerics]:
    """The same impact by the ``usual`` scheme, mass and enforcement, by the cause that errs where another is chosen.

    Half the steps alone do not tell: a method that chatters loses contact at once however short they are.
    """
    other = [key for key, name in usual.items() if getattr(numerics, key) != name]
    if not other:
        return {}
    return {"penalty" if "enforcement" in other else "mesh": numerics.varied(**usual)}
