"""Physics of impact without a mesh: materials, shapes, scenes, histories, force laws."""

from lumped import laws as laws
from lumped import restitution as restitution
from lumped.errors import BadInput as BadInput
from lumped.errors import Fault as Fault
from lumped.errors import FeContactError as FeContactError
from lumped.errors import NotReached as NotReached
from lumped.fit import Fit as Fit
from lumped.fit import fit as fit
from lumped.identify import Identified as Identified
from lumped.identify import identify as identify
from lumped.laws.base import simulate as simulate
from lumped.materials import Creep as Creep
from lumped.materials import Material as Material
from lumped.materials import Relaxation as Relaxation
from lumped.result.history import History as History
from lumped.result.result import LedgerEntry as LedgerEntry
from lumped.result.result import Quantity as Quantity
from lumped.result.result import Result as Result
from lumped.result.score import Score as Score
from lumped.result.score import score as score
from lumped.scene.scene import Scene as Scene
from lumped.scene.tables import Model as Model
from lumped.scene.tables import Motion as Motion
from lumped.shapes import Sphere as Sphere
from lumped.solvers import stereomechanics as stereomechanics
