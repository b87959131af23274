"""Section 5 of the paper: a structure with a pounding tuned mass damper, in free vibration."""

from lumped.ptmd.free_vibration import simulate as simulate
from lumped.ptmd.result import Energy as Energy
from lumped.ptmd.result import Measures as Measures
from lumped.ptmd.result import PtmdContact as PtmdContact
from lumped.ptmd.result import PtmdMotion as PtmdMotion
from lumped.ptmd.result import PtmdResult as PtmdResult
from lumped.ptmd.system import Memory as Memory
from lumped.ptmd.system import Oscillator as Oscillator
from lumped.ptmd.system import PoundingDamper as PoundingDamper
from lumped.ptmd.system import PtmdRing as PtmdRing
from lumped.ptmd.system import Start as Start
