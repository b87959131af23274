"""What happens to a material's memory between two contacts: one rule a file (the paper's Fig. 15)."""

from lumped.schema.members import Folder
from lumped.solvers.point.memory.base import MemoryRule

RULES = Folder[MemoryRule](__name__, source="law", key="memory")
