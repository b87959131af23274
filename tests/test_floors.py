"""The floors of the house: which package may import what, and what stands nowhere."""

from __future__ import annotations

import ast
import runpy
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from fnmatch import filter as matching
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("lumped", "meshes", "fe_contact")
FILES = {"pyproject.toml", "README.md", "LICENSE", "CITATION.cff", "CHANGELOG.md"}
TOP_LEVEL = FILES | {"data", "tests"} | {*PACKAGES}

STANDARD = sys.stdlib_module_names
LUMPED = STANDARD | {"lumped", "numpy", "scipy", "pandas"}
MESHES = STANDARD | {"meshes", "numpy", "scipy", "skfem", "meshio", "gmsh"}
ONE_IMPORTER = {
    "distributed": "fe_contact/studies/workers.py",
    "gmsh": "meshes/session.py",
    "jinja2": "fe_contact/studies/validate/_page.py",
    "markdown": "fe_contact/manual/site.py",
    "pandas": "lumped/result/history.py",
    "pyarrow": "fe_contact/studies/files.py",
}
FINITE_ELEMENTS = LUMPED | MESHES | {"fe_contact", "matplotlib", "threadpoolctl", *ONE_IMPORTER}
ALLOWED = {"lumped": LUMPED, "meshes": MESHES, "fe_contact": FINITE_ELEMENTS}
HEAVY = {"skfem", "gmsh", "matplotlib", "meshio", "scipy.integrate"}
NOT_LOADED = {
    "lumped": HEAVY | {"meshes", "fe_contact", "pandas", "lumped.laws"},
    "meshes": {"lumped", "fe_contact", "skfem", "gmsh", "matplotlib"},
    "fe_contact": {"matplotlib", "scipy.integrate", *ONE_IMPORTER},
}
SERIALIZERS = {"pickle", "_pickle", "cloudpickle", "dill", "joblib", "marshal", "shelve"}


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """All of a file, for every test that asks."""
    return tuple(ast.walk(tree(path)))


def sources(*folders: str) -> list[Path]:
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


@cache
def modules_imported(path: Path) -> tuple[str, ...]:
    """Full names of all modules that a file imports, at any depth, written as a statement or as a call."""
    return tuple(_imported(path))


def _imported(path: Path) -> Iterator[str]:
    for node in nodes(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module
        elif isinstance(node, ast.Call) and called(node) in ("import_module", "__import__") and node.args:
            first = node.args[0]
            if isinstance(first, ast.Constant) and isinstance(first.value, str):
                yield first.value


def roots_imported(path: Path) -> set[str]:
    return {module.split(".")[0] for module in modules_imported(path)}


def called(node: ast.Call) -> str:
    """The last name of what is called: `import_module` for `importlib.import_module(...)`."""
    return ast.unparse(node.func).rpartition(".")[2]


def importers(root: str) -> set[str]:
    """Files of the suite that import the package `root` or anything in it."""
    return {name(path) for path in sources(*PACKAGES) if root in roots_imported(path)}


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("package", PACKAGES)
def test_a_floor_imports_only_what_it_may(package: str) -> None:
    assert sources(package), f"{package} has no source"
    strangers = {
        f"{name(path)}: {module}"
        for path in sources(package)
        for module in modules_imported(path)
        if module.split(".")[0] not in ALLOWED[package]
    }
    assert not strangers


@pytest.mark.parametrize("package", PACKAGES)
def test_importing_a_package_loads_nothing_heavy(package: str) -> None:
    probe = f"import sys, {package}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", probe], cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert not NOT_LOADED[package] & set(run.stdout.split())


def test_only_charts_import_matplotlib() -> None:
    charts = {name(path) for path in (ROOT / "fe_contact/studies").rglob("*chart.py")}
    assert importers("matplotlib") <= charts | {"fe_contact/studies/style.py"}


@pytest.mark.parametrize("package", ONE_IMPORTER)
def test_one_file_alone_imports_it(package: str) -> None:
    assert importers(package) == {ONE_IMPORTER[package]}


def test_no_relative_import_leaves_its_package() -> None:
    """`from ...x import y` may climb, but not out of the package."""
    leaving = {
        name(path)
        for path in sources(*PACKAGES)
        for node in nodes(path)
        if isinstance(node, ast.ImportFrom) and node.level >= len(path.relative_to(ROOT).parts)
    }
    assert not leaving


@pytest.mark.parametrize("package", PACKAGES)
def test_no_files_import_each_other_in_a_circle(package: str) -> None:
    """Imports within functions and for type checkers count: what is read needs what it names."""
    TopologicalSorter({name(path): imported_files(path) for path in sources(package)}).prepare()


ROOMS = {  # lowest first
    "lumped": (
        "errors numbers progress schema load_curves materials shapes targets scene result solvers indentation laws "
        "restitution fit identify pounding ptmd paper __init__"
    ),
    "fe_contact": (
        "errors settings progress threads assembly contact schemes dynamics bodies steppers march targets solids "
        "budget fields plastic indentation recovery waves large_strains relaxing_impact relaxing_punch reference "
        "methods studies manual commands cli __main__ __init__"
    ),
}
FILES_AT_A_ROOT = 14


@pytest.mark.parametrize("package", ROOMS)
def test_rooms_stand_in_order_and_folders_import_one_way(package: str) -> None:
    """A new room has its place in ``ROOMS``: it knows those before it."""
    order, folders = ROOMS[package].split(), defaultdict[str, set[str]](set)
    for path in sources(package):
        for file in {file for file in imported_files(path) if file.startswith(f"{package}/")}:
            above, below = (parts.split("/")[1].removesuffix(".py") for parts in (name(path), file))
            assert order.index(above) >= order.index(below), f"{name(path)} takes something from {file}"
            if above == below:
                folders[name(path.parent)].add(file.rpartition("/")[0])
    TopologicalSorter({folder: lower - {folder} for folder, lower in folders.items()}).prepare()


@pytest.mark.parametrize("package", ROOMS)
def test_a_root_is_no_corridor(package: str) -> None:
    assert len(list((ROOT / package).glob("*.py"))) <= FILES_AT_A_ROOT


def imported_files(path: Path) -> set[str]:
    """Files of the suite, by name, that a file takes something from; a package's `__init__` hands on, no more."""
    found = set()
    for node in nodes(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    files = {module.replace(".", "/") + ".py" for module in found}
    return {file for file in files if (ROOT / file).is_file()}


def test_one_place_catches_everything() -> None:
    """A failure has a name; only the command line turns the rest into one line and exit code 1."""
    places = [name(path) for path in sources(*PACKAGES) for node in nodes(path) if catches_all(node)]
    assert places == ["fe_contact/cli.py"]


def catches_all(node: ast.AST) -> bool:
    if isinstance(node, ast.ExceptHandler):
        caught = ast.walk(node.type) if node.type else None
        return caught is None or any(is_broad(kind) for kind in caught)
    suppressed = node.args if isinstance(node, ast.Call) and called(node) == "suppress" else []
    return any(is_broad(kind) for kind in suppressed)


def is_broad(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id in ("Exception", "BaseException")


@pytest.mark.tenth
def test_nothing_is_pickled() -> None:
    """Results are text that a diff can show; a pickle runs code when it is read."""
    # a file that has none of the words need not be parsed: "pickle" is part of allow_pickle too
    texts = {path: path.read_text(encoding="utf-8") for path in sources(*PACKAGES, "tests")}
    everywhere = [path for path, text in texts.items() if any(word in text for word in SERIALIZERS)]
    importing = {name(path) for path in everywhere if SERIALIZERS & roots_imported(path)}
    loading = {
        name(path)
        for path in everywhere
        for node in nodes(path)
        if isinstance(node, ast.keyword) and node.arg == "allow_pickle"
    }
    assert not importing | loading


def test_the_top_level_is_the_agreed_one() -> None:
    """Apart from dot files and from what git ignores."""
    patterns = (ROOT / ".gitignore").read_text(encoding="utf-8").split()
    ignored = [".*", *(pattern.strip("/") for pattern in patterns)]
    entries = {path.name for path in ROOT.iterdir()}
    assert entries - {entry for pattern in ignored for entry in matching(entries, pattern)} == TOP_LEVEL


RIGID = {"plane"}  # has no mesh: what strikes it does
MESH_HELPERS = {"errors", "session", "triangles"}


def members(folder: str) -> set[str]:
    return {path.stem for path in (ROOT / folder).glob("[!_]*.py")} - {"base"}


def test_a_target_stands_on_every_floor() -> None:
    targets, meshed = members("lumped/targets"), members("meshes") - MESH_HELPERS
    assert targets
    assert members("fe_contact/targets") | members("fe_contact/waves/targets") == targets
    assert targets - RIGID <= meshed
    assert meshed <= targets | members("lumped/shapes"), "a mesh of neither a target nor a deformable striker"


def test_every_folder_of_source_is_a_package() -> None:
    """A folder without __init__.py imports all the same, but neither mypy nor a walk over members sees it."""
    bare = {name(path.parent) for path in sources(*PACKAGES) if not (path.parent / "__init__.py").exists()}
    assert not bare


def test_what_mutants_are_drawn_from_and_what_does_no_harm_is_there() -> None:
    script = runpy.run_path(str(ROOT / "tests" / "mutants.py"))
    files, mutants = [name(path) for path in sources(*PACKAGES)], cache(script["all_of"])
    assert not [pattern for pattern in script["CORE"] if not matching(files, pattern)]
    for pattern, scope, begins in script["HARMLESS"]:
        there = [one for file in matching(files, pattern) for one in mutants(file) if one.scope == scope]
        assert any(one.change.startswith(begins) for one in there), (pattern, scope, begins)


ERROR_PATH = ("certify", "variation")


def test_the_manual_tells_every_constant_on_the_way_to_a_bar_as_the_code_has_it() -> None:
    script = runpy.run_path(str(ROOT / "tests" / "constants.py"))
    assert script["table"]() in script["PAGE"].read_text(encoding="utf-8"), "cure: python tests/constants.py --write"
    for module in ERROR_PATH:
        tree = ast.parse((ROOT / "fe_contact" / "budget" / f"{module}.py").read_text(encoding="utf-8"))
        numbers = {target.id for node in tree.body if isinstance(node, ast.Assign) for target in named(node)}
        told = {one.name for one in script["TABLE"] if one.module == f"fe_contact.budget.{module}"}
        assert numbers == told, module


def named(node: ast.Assign) -> Iterator[ast.Name]:
    """Constants of numbers alone."""
    constants = [part.value for part in ast.walk(node.value) if isinstance(part, ast.Constant)]
    if any(isinstance(value, float | int) for value in constants):
        yield from (target for target in node.targets if isinstance(target, ast.Name) and target.id.isupper())


@pytest.mark.parametrize("package", PACKAGES)
def test_one_name_is_one_class(package: str) -> None:
    names = [node.name for path in sources(package) for node in tree(path).body if isinstance(node, ast.ClassDef)]
    assert not {name for name in names if names.count(name) > 1}


MOST_ANY = 60  # each with its reason beside it: what a library leaves untyped, values of keys


def test_joints_are_typed() -> None:
    """No module stands in for a member, no attribute is probed, and few things have any type."""
    used = Counter(
        node.id
        for path in sources(*PACKAGES)
        for node in nodes(path)
        if isinstance(node, ast.Name) and node.id in ("ModuleType", "hasattr", "Any")
    )
    assert not used["hasattr"]
    assert not used["ModuleType"]
    assert used["Any"] <= MOST_ANY


def only_numbers(value: ast.expr | None) -> bool:
    """A number, or a tuple, list or dict of nothing else."""
    if isinstance(value, ast.UnaryOp):
        return only_numbers(value.operand)
    if isinstance(value, ast.BinOp):
        return only_numbers(value.left) and only_numbers(value.right)
    if isinstance(value, ast.Tuple | ast.List | ast.Dict):
        inside = value.values if isinstance(value, ast.Dict) else value.elts
        return bool(inside) and all(map(only_numbers, inside))
    return isinstance(value, ast.Constant) and type(value.value) in (int, float)


def constants(path: Path) -> Iterator[ast.Assign | ast.AnnAssign]:
    """Where upper-case names of a module are given numbers."""
    for node in tree(path).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and only_numbers(node.value):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            if all(isinstance(name, ast.Name) and name.id.isupper() for name in names):
                yield node


def test_every_constant_says_what_it_is() -> None:
    """A comment on its lines or on the line before: its unit, and whether it is physics, safety, rounding or work."""
    silent, count = list[str](), 0
    for path in sources(*PACKAGES):
        lines = path.read_text(encoding="utf-8").splitlines()
        for node in constants(path):
            count += 1
            own = lines[node.lineno - 1 : node.end_lineno]
            if not any("#" in line for line in own) and not lines[node.lineno - 2].startswith("#"):
                silent.append(f"{path.relative_to(ROOT)}:{node.lineno}: {own[0]}")
    assert count > 100
    assert silent == []
