"""Named failures of the geometry floor."""

APT_LINE = (
    "apt-get update && apt-get install -y --no-install-recommends "
    "libglu1-mesa libgl1 libxcursor1 libxft2 libxinerama1 libgomp1"
)


class MeshError(Exception):
    """A mesh that cannot be made: the message says in plain words which number, and its accepted range."""

    exit_code = 2


class MeshTooFine(MeshError):
    """More elements along a contact than a mesh is made for."""


class GmshMissing(MeshError):
    """gmsh is installed but a system library it needs is not (bare Debian lacks libGLU and friends)."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"gmsh cannot be loaded ({reason}); cure: {APT_LINE}")
