"""Linear viscoelastic materials: one network a file in `networks`, all of them a Prony series inside."""

from lumped.materials.material import Material as Material
from lumped.materials.relaxation import Creep as Creep
from lumped.materials.relaxation import Fidelity as Fidelity
from lumped.materials.relaxation import Recovery as Recovery
from lumped.materials.relaxation import Relaxation as Relaxation
