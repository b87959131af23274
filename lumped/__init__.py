"""Physics of impact without a mesh: materials, shapes, scenes, histories, force laws."""

from lumped import laws as laws
from lumped import restitution as restitution
from lumped import stereomechanics as stereomechanics
from lumped.errors import BadInput as BadInput
from lumped.errors import Fault as Fault
from lumped.errors import FeContactError as FeContactError
from lumped.errors import NotReached as NotReached
from lumped.fit import Fit as Fit
from lumped.fit import fit as fit
from lumped.history import History as History
from lumped.laws.base import simulate as simulate
from lumped.materials import Creep as Creep
from lumped.materials import Material as Material
from lumped.materials import Relaxation as Relaxation
from lumped.result import Quantity as Quantity
from lumped.result import Result as Result
from lumped.scene import Scene as Scene
from lumped.scene_tables import Model as Model
from lumped.scene_tables import Motion as Motion
from lumped.score import Score as Score
from lumped.score import score as score
from lumped.shapes import Sphere as Sphere
from lumped.sufficiency import LedgerEntry as LedgerEntry
