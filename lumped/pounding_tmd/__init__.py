"""Section 5 of the paper: a structure with a pounding tuned mass damper, in free vibration."""

from lumped.pounding_tmd.free_vibration import simulate as simulate
from lumped.pounding_tmd.result import Contact as Contact
from lumped.pounding_tmd.result import Energy as Energy
from lumped.pounding_tmd.result import Measures as Measures
from lumped.pounding_tmd.result import Motion as Motion
from lumped.pounding_tmd.result import PtmdResult as PtmdResult
from lumped.pounding_tmd.system import Memory as Memory
from lumped.pounding_tmd.system import Oscillator as Oscillator
from lumped.pounding_tmd.system import PoundingDamper as PoundingDamper
from lumped.pounding_tmd.system import Ring as Ring
from lumped.pounding_tmd.system import Start as Start
