"""Named failures of the geometry floor."""

from typing import Any

APT_LINE = (
    "apt-get update && apt-get install -y --no-install-recommends "
    "libglu1-mesa libgl1 libxcursor1 libxft2 libxinerama1 libgomp1"
)


class MeshError(Exception):
    """A mesh that cannot be made: the message says in plain words which number, and its accepted range."""

    exit_code = 2

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process gets what it says, not what it was made of: kinds differ in their arguments."""
        return type(self).__new__, (type(self), *self.args), self.__dict__


class MeshTooLarge(MeshError):
    """A mesh of so many nodes would keep gmsh busy for minutes: a question of work, not of accepted numbers."""

    exit_code = 3

    def __init__(self, most: int) -> None:
        self.what = f"a mesh of more than {most} nodes, or of a quarter as many along its boundary"
        cure = "fewer elements along a contact, a thicker body, a nearer far end"
        super().__init__(f"{self.what}, is not made; cure: {cure}")


class MeshTooFine(MeshError):
    """More elements along a contact than a mesh is made for."""


class GmshMissing(MeshError):
    """gmsh, or a system library that it needs, is not installed (bare Debian lacks libGLU and friends)."""

    def __init__(self, reason: str, cure: str = APT_LINE) -> None:
        super().__init__(f"gmsh cannot be loaded ({reason}); cure: {cure}")
