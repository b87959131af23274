"""Section 5 of the paper: a structure with a pounding tuned mass damper, in free vibration."""

from lumped.ptmd.free_vibration import simulate as simulate
from lumped.ptmd.system import Energy as Energy
from lumped.ptmd.system import Measures as Measures
from lumped.ptmd.system import Memory as Memory
from lumped.ptmd.system import Oscillator as Oscillator
from lumped.ptmd.system import PoundingDamper as PoundingDamper
from lumped.ptmd.system import PtmdContact as PtmdContact
from lumped.ptmd.system import PtmdMotion as PtmdMotion
from lumped.ptmd.system import PtmdResult as PtmdResult
from lumped.ptmd.system import PtmdRing as PtmdRing
from lumped.ptmd.system import Start as Start
