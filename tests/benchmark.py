"""What an impact costs, as multiples of bare imports measured in the same run. A script, not a test.

    python tests/benchmark.py

Every cold run is a process of its own with a velocity nobody used before, and no run reads what is known on disk, so
that nothing can be remembered.
Process CPU (user and system) of the child; medians of five, the runs of all kinds interleaved.
"""

from __future__ import annotations

import os
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from lumped import Scene, laws, simulate
from lumped.laws import mdr

ROOT = Path(__file__).resolve().parent.parent
REPEATS = 5
IMPORTS = "import numpy, scipy.sparse.linalg, scipy.linalg, skfem, gmsh, meshio"
TOLERANCES = ("1e-3", "1e-4")
BOUNDS = {"1e-3": 3.0, "1e-4": 4.0}
# Another impact as a multiple of bare imports, where these take 0.4 s: 50 ms.
TABLE1_BOUND, STABILITY_BOUND = 75, 150  # 30 s and 60 s where bare imports take 0.4 s
MARGINAL_BOUND, MARGINAL_REPEATS = 50e-3 / 0.4, 15
MEGABYTE = 1024  # ru_maxrss counts kilobytes
# One impact between two masses: 5 ms where bare imports take 0.4 s; a study of many.
FORCE_BOUND, FORCE_TOLERANCE, FORCE_SAMPLES = 5e-3 / 0.4, 1e-3, 21
FORCE_STUDY, STUDY_BOUND = 10_000, 60.0 / 0.4
# Impacts of lumped laws as multiples of bare imports, where these take 0.4 s: 5 ms and 30 ms.
LAW_BOUNDS = {"correspondence": 5e-3 / 0.4, "ting": 30e-3 / 0.4, "mdr": 30e-3 / 0.4}
LAW_TOLERANCE, LAW_REPEATS = 1e-5, 15

# One impact with waves in a process of its own: 400 implicit steps of some 3000 unknowns.
WAVES = """
from lumped import Scene
from fe_contact.waves.targets.half_space import moving
from fe_contact.waves.impact import motion
from fe_contact.waves.targets.half_space import plan
scene = Scene.load("steel-ball-waves")
numerics = plan(scene, {"steps": 400, "elements_per_contact": 4.0}).numerics
body = moving(scene, numerics)
assert 2900 <= body.body.size <= 3400, body.body.size
assert len(motion(body, scene, numerics).samples) >= 400
"""
WAVES_BOUND = 4.0

# The deepest of twenty slow indentations of every row of Table 1 and what lies between them, m.
ROW_DEPTHS = {
    "polymer-sphere": 3e-4, "polymer-cone": 3e-4, "polymer-power": 3e-4, "polymer-punch": 3e-4,
    "polymer-prism": 1e-3, "polymer-plate": 3e-4, "polymer-half-plane": 3e-4, "polymer-layer": 3e-4,
    "polymer-layer-line": 3e-4, "polymer-layer-sliding": 3e-4, "polymer-o-ring": 5e-4, "polymer-washer": 3e-4,
    "rod-in-ring": 3e-4, "two-spheres": 1e-4, "two-cylinders": 1e-4, "two-finite-spheres": 1e-4,
}  # fmt: skip
ROW_BOUND, ROW_MEMORY, ROW_REPEATS, ROW_SHALLOWEST = 3.0, 500, 3, 0.02


def child(arguments: list[str]) -> tuple[float, float]:
    """CPU seconds and peak memory, MB, of a Python process of its own."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    probe = (
        "import resource, subprocess, sys\n"
        "code = subprocess.call(sys.argv[1:], stdout=subprocess.DEVNULL)\n"
        "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
        "print(code, used.ru_utime + used.ru_stime, used.ru_maxrss)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", probe, sys.executable, *arguments],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    code, cpu, memory = done.stdout.split()
    if code != "0":
        raise SystemExit(f"{' '.join(arguments)} ended with {code}:\n{done.stderr}")
    return float(cpu), float(memory) / MEGABYTE


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def run_once(tolerance: str, folder: str) -> tuple[float, float]:
    velocity = f"striker.velocity={random.SystemRandom().uniform(0.015, 0.025)!r}"
    command = ["run", "polymer-sphere", "--tolerance", tolerance, "--set", velocity, "--out", folder, "--quiet"]
    return child(["-m", "fe_contact", *command])


def cold() -> float:
    """Whole processes against bare imports, whose CPU seconds it returns."""
    found: dict[str, list[tuple[float, float]]] = {"imports": [], **{t: [] for t in TOLERANCES}}
    with tempfile.TemporaryDirectory() as folder:
        run_once(TOLERANCES[0], folder)  # so that the libraries' files are in memory
        for _ in range(REPEATS):
            found["imports"].append(child(["-c", IMPORTS]))
            for tolerance in TOLERANCES:
                found[tolerance].append(run_once(tolerance, folder))
    cpu = {kind: statistics.median(run[0] for run in runs) for kind, runs in found.items()}
    memory = {kind: max(run[1] for run in runs) for kind, runs in found.items()}
    say(f"bare imports            {cpu['imports']:.3f} s CPU, {memory['imports']:.0f} MB")
    for tolerance in TOLERANCES:
        ratio = cpu[tolerance] / cpu["imports"]
        say(
            f"fe-contact run, {tolerance}    {cpu[tolerance]:.3f} s CPU = {ratio:.2f} x imports "
            f"(bound {BOUNDS[tolerance]:g}), {memory[tolerance]:.0f} MB (bound 300)"
        )
    return cpu["imports"]


def commanded(*command: str, bound: float) -> None:
    """A study, its two processes together, by the clock and by their CPU, against bare imports."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        imports, _ = child(["-c", IMPORTS])
        middle = time.perf_counter()
        cpu, memory = child(["-m", "fe_contact", *command, "--out", folder, "--quiet"])
        clock, waited = time.perf_counter() - middle, middle - start
    say(
        f"fe-contact {' '.join(command):12s} {cpu:.1f} s CPU of both = {cpu / imports:.0f} x imports, "
        f"{clock / waited:.0f} x by the clock (bound {bound}), {memory:.0f} MB each (bound {ROW_MEMORY})"
    )


def indent_rows() -> None:
    """Twenty slow indentations of every row, a whole process each, against bare imports between them."""
    with tempfile.TemporaryDirectory() as folder:
        for name, deepest in ROW_DEPTHS.items():
            imports, rows = [], []
            for _ in range(ROW_REPEATS):
                imports.append(child(["-c", IMPORTS])[0])
                rows.append(indent_once(name, deepest, folder))
            ratio = statistics.median(cpu for cpu, _ in rows) / statistics.median(imports)
            memory = max(memory for _, memory in rows)
            say(
                f"fe-contact indent, 20 depths, {name:22} {ratio:.2f} x imports (bound {ROW_BOUND:g}), "
                f"{memory:.0f} MB (bound {ROW_MEMORY})"
            )


def indent_once(name: str, deepest: float, folder: str) -> tuple[float, float]:
    shallowest = ROW_SHALLOWEST * random.SystemRandom().uniform(1.0, 1.1)
    depths = ",".join(repr(deepest * shallowest ** (share / 19.0)) for share in range(20))
    return child(["-m", "fe_contact", "indent", name, "--depths", depths, "--out", folder, "--quiet"])


def waves() -> None:
    """An impact with inertia, a whole process, against bare imports between them."""
    imports, impacts = [], []
    for _ in range(REPEATS):
        imports.append(child(["-c", IMPORTS])[0])
        impacts.append(child(["-c", WAVES])[0])
    ratio = statistics.median(impacts) / statistics.median(imports)
    say(f"impact with waves, 400 steps, 3000 unknowns {ratio:.2f} x imports (bound {WAVES_BOUND:g})")


def marginal(imports: float) -> None:
    """Another impact on meshes that are there already, within this process: from scene to result, bars included."""
    sys.path.insert(0, str(ROOT))
    import fe_contact
    import lumped
    from fe_contact.budget.plan import plan
    from fe_contact.march.impact import march
    from fe_contact.steppers.steps import Strike
    from fe_contact.targets import half_space

    rng = random.SystemRandom()
    for tolerance in TOLERANCES:
        spent: dict[str, list[float]] = {"march": [], "run": []}
        for repeat in range(MARGINAL_REPEATS + 1):
            scene = lumped.Scene.load("polymer-sphere", {"striker.velocity": rng.uniform(0.015, 0.025)})
            numerics, strike = plan(scene, {"tolerance": float(tolerance)}).numerics, Strike.of(scene)
            surface = half_space.surface(scene.material.nu, numerics)
            start = time.process_time()
            march(strike, surface, numerics)
            middle = time.process_time()
            fe_contact.run(scene, float(tolerance))
            if repeat:  # the first one makes the meshes
                spent["march"].append(middle - start)
                spent["run"].append(time.process_time() - middle)
        one, all_of_it = (statistics.median(times) for times in spent.values())
        say(
            f"another impact, {tolerance}    {1e3 * all_of_it:.0f} ms = {all_of_it / imports:.3f} x imports "
            f"(bound {MARGINAL_BOUND:g}), of which the finest march {1e3 * one:.0f} ms"
        )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MEGABYTE
    say(f"this process            {peak:.0f} MB")


def one_impact(law: str, scenes: list[Scene]) -> float:
    """Median CPU seconds of one impact by a law, the first left out."""
    spent = []
    for scene in scenes:
        start = time.process_time()
        simulate(laws.get(law).of(scene), scene, LAW_TOLERANCE)
        spent.append(time.process_time() - start)
    return statistics.median(spent[1:])


def lumped_laws(imports: float) -> None:
    """Impacts by the laws with memory, as multiples of bare imports."""
    rng = random.SystemRandom()
    for name, base in (("polymer-sphere", 0.02), ("steel-ball-sls", 1.0)):
        speeds = [base * rng.uniform(0.75, 1.25) for _ in range(LAW_REPEATS + 1)]
        scenes = [Scene.load(name, {"striker.velocity": speed}) for speed in speeds]
        for law, bound in LAW_BOUNDS.items():
            cpu = one_impact(law, scenes)
            say(f"{law:14} {name:15} {1e3 * cpu:6.1f} ms = {cpu / imports:.4f} x imports (bound {bound:.4f})")
        start = time.process_time()
        for scene in scenes:
            mdr.estimate(scene)
        cpu = (time.process_time() - start) / len(scenes)
        bound = LAW_BOUNDS["correspondence"]
        say(f"mdr.estimate   {name:15} {1e3 * cpu:6.1f} ms = {cpu / imports:.4f} x imports (bound {bound:.4f})")


def force_laws() -> None:
    """Every law between two masses: one impact by one march, and as a Result with bars, rows and ledgers."""
    from lumped import Scene, laws

    rng = random.SystemRandom()
    imports = statistics.median(child(["-c", IMPORTS])[0] for _ in range(REPEATS))
    for name in laws.available():
        module = laws.get(name)
        if "k" not in module.keys:
            continue
        law = {"name": name, "k": 1e8, **({"e": 0.6} if "e" in module.keys else {})}
        lean, whole = [], []
        for _ in range(FORCE_SAMPLES):
            striker = {"mass": rng.uniform(500.0, 2000.0), "velocity": rng.uniform(0.1, 2.0)}
            scene = Scene.from_dict({"striker": striker, "law": law})
            model, start = module.of(scene), time.process_time()
            model.outcome(scene, FORCE_TOLERANCE)
            middle = time.process_time()
            model.simulate(scene, FORCE_TOLERANCE)
            lean.append(middle - start)
            whole.append(time.process_time() - middle)
        one, all_of_it = statistics.median(lean), statistics.median(whole)
        lean_said = f"{1e3 * one:5.1f} ms = {one / imports:.4f} x imports"
        whole_said = f"as a Result {1e3 * all_of_it:5.1f} ms = {all_of_it / imports:.4f}"
        say(f"{name:15} {lean_said}, {whole_said} (bound of both {FORCE_BOUND:.4f})")


def studied(seed: int) -> float | None:
    """The restitution of an impact of a study: a law of those between two masses, or the correspondence law, each over
    decades of its parameters.
    """
    rng = random.Random(seed)
    names = [name for name in laws.available() if "k" in laws.get(name).keys]
    name = rng.choice([*names, "correspondence"])
    striker = {"mass": 10.0 ** rng.uniform(0.0, 4.0), "velocity": 10.0 ** rng.uniform(-1.0, 0.7)}
    if name == "correspondence":
        striker |= {"shape": "sphere", "radius": 10.0 ** rng.uniform(-1.5, 0.0)}
        solid = {"law": "sls", "E0": 10.0 ** rng.uniform(9.0, 11.0), "R1": 10.0 ** rng.uniform(-1.0, 0.5)}
        solid |= {"R2": 10.0 ** rng.uniform(-5.0, 0.0), "nu": 0.3}
        scene = Scene.from_dict({"striker": striker, "target": {"shape": "half_space", "material": solid}})
    else:
        law = {"name": name, "k": 10.0 ** rng.uniform(6.0, 10.0)}
        law |= {"e": rng.uniform(0.1, 0.95)} if "e" in laws.get(name).keys else {}
        scene = Scene.from_dict({"striker": striker, "law": law})
    return simulate(laws.get(name).of(scene), scene, FORCE_TOLERANCE).quantities["restitution"].value


def study() -> None:
    """Ten thousand whole Results, all different, in two processes, by the clock against bare imports before them."""
    begin = time.perf_counter()
    child(["-c", IMPORTS])
    middle = time.perf_counter()
    seeds = random.SystemRandom().sample(range(2**32), FORCE_STUDY)
    with ProcessPoolExecutor(2) as pool:
        ended = sum(found is not None for found in pool.map(studied, seeds, chunksize=100))
    clock, imports = time.perf_counter() - middle, middle - begin
    say(
        f"{FORCE_STUDY} impacts in two processes, {ended} with a restitution: {clock:.0f} s = {clock / imports:.0f} x "
        f"imports by the clock (bound {STUDY_BOUND:.0f})"
    )


if __name__ == "__main__":
    os.environ["FE_CONTACT_CACHE"] = "off"
    imports = cold()
    indent_rows()
    commanded("table1", bound=TABLE1_BOUND)
    commanded("stability", "--quick", bound=STABILITY_BOUND)
    waves()
    marginal(imports)
    lumped_laws(imports)
    force_laws()
    study()
