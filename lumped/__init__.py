"""Physics of impact without a mesh: materials, shapes, scenes, histories, force laws."""

from importlib import import_module as _import_module
from typing import TYPE_CHECKING

from lumped.errors import BadInput, Fault, FeContactError, NotReached
from lumped.fit import Fit, fit
from lumped.identify import Identified, identify
from lumped.materials import Creep, Material, Relaxation
from lumped.result.history import History
from lumped.result.result import LedgerEntry, Quantity, Result
from lumped.result.score import Score, score
from lumped.scene.scene import Scene
from lumped.scene.tables import Model, Motion
from lumped.shapes import Sphere
from lumped.solvers import stereomechanics

if TYPE_CHECKING:
    from lumped import laws, restitution
    from lumped.laws.base import simulate

__all__ = [
    "BadInput",
    "Creep",
    "Fault",
    "FeContactError",
    "Fit",
    "History",
    "Identified",
    "LedgerEntry",
    "Material",
    "Model",
    "Motion",
    "NotReached",
    "Quantity",
    "Relaxation",
    "Result",
    "Scene",
    "Score",
    "Sphere",
    "fit",
    "identify",
    "laws",
    "restitution",
    "score",
    "simulate",
    "stereomechanics",
]


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> object:
    """Of the laws, which are imported when they are first asked for: finite elements need none."""
    if name in ("laws", "restitution"):
        return _import_module(f"{__name__}.{name}")
    if name == "simulate":
        return _import_module(f"{__name__}.laws.base").simulate
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
