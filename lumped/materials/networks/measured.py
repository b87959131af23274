"""Storage and loss moduli measured over frequency: the Prony series closest to them, its deviation in the model ledger.

The table has the columns storage_Pa, loss_Pa and one of frequency_Hz, angular_frequency_rad_per_s.
"""

from pathlib import Path
from typing import Annotated

from lumped.materials.dynamic_moduli import DynamicModuli
from lumped.materials.networks.base import Network
from lumped.materials.prony_fit import of_dynamic
from lumped.materials.relaxation import Relaxation
from lumped.schema.keys import File, Flag, Key


def of(
    file: Annotated[Path, Key(File(), "table of the measured moduli")],
    viscous: Annotated[bool, Key(Flag(), "whether a dashpot in parallel may help")] = False,
) -> Relaxation:
    """E(t) of a CSV file of Young's moduli; `viscous` allows for a dashpot in parallel. Raises BadInput."""
    return of_dynamic(DynamicModuli.read_csv(file), viscous=viscous).relaxation


MEMBER = Network((of,))
