"""Physics of impact without a mesh: materials, shapes, scenes, histories, force laws."""

from lumped import laws, restitution
from lumped.errors import BadInput, Fault, FeContactError, NotReached
from lumped.fit import Fit, fit
from lumped.identify import Identified, identify
from lumped.laws.base import simulate
from lumped.materials import Creep, Material, Relaxation
from lumped.result.history import History
from lumped.result.result import LedgerEntry, Quantity, Result
from lumped.result.score import Score, score
from lumped.scene.scene import Scene
from lumped.scene.tables import Model, Motion
from lumped.shapes import Sphere
from lumped.solvers import stereomechanics

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
