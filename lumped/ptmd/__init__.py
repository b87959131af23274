"""Section 5 of the paper: a structure with a pounding tuned mass damper, in free vibration."""

from lumped.ptmd.free_vibration import simulate as simulate
from lumped.ptmd.result import Contact as Contact
from lumped.ptmd.result import Energy as Energy
from lumped.ptmd.result import Measures as Measures
from lumped.ptmd.result import Motion as Motion
from lumped.ptmd.result import PtmdResult as PtmdResult
from lumped.ptmd.system import Memory as Memory
from lumped.ptmd.system import Oscillator as Oscillator
from lumped.ptmd.system import PoundingDamper as PoundingDamper
from lumped.ptmd.system import Ring as Ring
from lumped.ptmd.system import Start as Start
