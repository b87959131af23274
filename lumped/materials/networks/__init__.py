"""Spring-dashpot networks, one a file: a member makes the Relaxation that a material's table describes."""

from lumped.materials.networks.base import Network as Network
from lumped.schema.members import Folder

NETWORKS = Folder[Network](__name__)
