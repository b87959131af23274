"""A script, not a test: what everything costs, in bare imports measured beside it, against a stored record.

    python tests/benchmark.py [GROUP ...] [--repeats N] [--record]

A group is a function below that yields ratios. Every cold run is a process of its own with a speed that nobody used
before, and reads no operators from disk, so that nothing can be remembered; what is read is bytecode, which an
installer makes of the suite as it did of what is imported. CPU counts user and system time of a process and
its children; a ratio by the clock says so. `--record` keeps what was measured in `tests/benchmark.json` and writes the
README's table from it; without it each ratio stands beside the recorded one. Work is counted, not timed: marches,
solves and iterations of one run, which a change of speed alone must leave as they are.
"""

from __future__ import annotations

import argparse
import compileall
import json
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import fe_contact
from lumped import Scene, laws, simulate
from lumped.laws import mdr

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("lumped", "meshes", "fe_contact")
RECORD = ROOT / "tests" / "benchmark.json"
README = ROOT / "README.md"
TABLE = re.compile(r"(?<=<!-- benchmark -->\n).*?(?=<!-- end of benchmark -->)", re.DOTALL)

REPEATS = 3
IMPORTS = "import numpy, scipy.sparse.linalg, scipy.linalg, skfem, gmsh, meshio"
SECOND = 1 / 0.4  # in bare imports, for goals that were set in seconds
MEGABYTE = 1024  # ru_maxrss counts kilobytes
RUN_MEMORY, STUDY_MEMORY = 300.0, 500.0  # MB

# The tolerance of a run and the scene it is asked of, with the most it should cost.
RUNS = [
    ("polymer-sphere", "1e-2", 3.0), ("polymer-sphere", "1e-3", 3.0), ("polymer-sphere", "1e-4", 4.0),
    ("polymer-layer", "1e-3", 15.0), ("rod-in-ring", "1e-3", 15.0), ("polymer-o-ring", "1e-3", 6.1),
    ("rubber-layer-bulk", "1e-3", 7.3), ("polymer-sphere-waves", "3e-3", 6.8), ("polymer-layer-waves", "3e-3", 6.6),
    ("steel-on-steel-waves", "3e-3", 7.3), ("polymer-sphere-finite", "1e-3", 30.0),
    ("rod-in-ring-finite", "1e-3", 30.0), ("steel-ball-plastic", "5e-3", 60.0), ("steel-ball-plastic", "1e-3", 60.0),
]  # fmt: skip
# The deepest of twenty slow indentations of every row of Table 1 and what lies between them, m.
ROW_DEPTHS = {
    "polymer-sphere": 3e-4, "polymer-cone": 3e-4, "polymer-power": 3e-4, "polymer-punch": 3e-4,
    "polymer-prism": 1e-3, "polymer-plate": 3e-4, "polymer-half-plane": 3e-4, "polymer-layer": 3e-4,
    "polymer-layer-line": 3e-4, "polymer-layer-sliding": 3e-4, "polymer-o-ring": 5e-4, "polymer-washer": 3e-4,
    "rod-in-ring": 3e-4, "two-spheres": 1e-4, "two-cylinders": 1e-4, "two-finite-spheres": 1e-4,
}  # fmt: skip
ROW_BOUND, ROW_SHALLOWEST = 3.0, 0.02
STUDIES = [
    (("table1",), 75.0), (("stability", "--quick"), 150.0), (("tradeoff", "polymer-sphere", "--quick"), 40.0),
    *(((("transfer", name), 60.0)) for name in
      ("steel-ball-sls", "polymer-sphere", "polymer-layer", "rod-in-ring", "concrete-pole")),
    (("pound", "two-frames"), 10.0), (("export", "polymer-layer", "--to", "calculix", "--depth", "1e-4"), 10.0),
    (("validate", "--quick"), 600.0),
]  # fmt: skip
COMPARED, COMPARE_RUNS = "polymer-layer", 3.0
MARGINAL_BOUND, MARGINAL_REPEATS = 50e-3 * SECOND, 15
FORCE_BOUND, FORCE_TOLERANCE = 5e-3 * SECOND, 1e-3
LAW_BOUNDS = {"correspondence": 5e-3 * SECOND, "ting": 30e-3 * SECOND, "mdr": 30e-3 * SECOND}
LAW_TOLERANCE, LAW_SAMPLES = 1e-5, 15
TING_STUDY, TING_BOUND = 1_000, 25.0  # a tenth of 10,000 and of its 250 imports
# Whole sweeps in two processes by the clock: base scene, method, cases measured, imports allowed for so many.
SWEEPS = [
    ("polymer-sphere", "fe", 300, 45.0),
    ("polymer-layer", "fe", 200, 90.0),
    ("polymer-sphere", "correspondence", 20_000, 60.0),
]
# Groups of which the README shows one row.
MANY = {"indent": " (the dearest row)", "law": " (the dearest law)"}
COUNTED = ("polymer-sphere", "polymer-layer", "rod-in-ring", "polymer-prism", "two-spheres", "ball-bouncing")


@dataclass(frozen=True)
class Ratio:
    """A cost in bare imports: median, least and most of the repeats; ``bound`` is the goal; ``memory`` in MB or 0."""

    group: str
    what: str
    median: float
    least: float
    most: float
    bound: float
    memory: float = 0.0

    @classmethod
    def of(cls, group: str, what: str, samples: list[float], bound: float, memory: float = 0.0) -> Ratio:
        return cls(group, what, statistics.median(samples), min(samples), max(samples), bound, memory)

    def line(self, older: Ratio | None) -> str:
        """With what the record says, and a word where the two spreads do not touch or a goal is missed."""
        said = f"{self.group:10} {self.what:46} {self.median:8.3g} ({self.least:.3g} to {self.most:.3g})"
        said += f", goal {self.bound:.3g}" + (f", {self.memory:.0f} MB" if self.memory else "")
        if older is not None:
            apart = self.least > older.most or self.most < older.least
            said += f"; recorded {older.median:.3g}" + (", changed" if apart else "")
        return said + ("" if self.median <= self.bound else "; missed")


def child(arguments: list[str]) -> tuple[float, float, float]:
    """CPU seconds, seconds by the clock and peak memory, MB, of a Python process of its own and its children."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    probe = (
        "import resource, subprocess, sys, time\n"
        "start = time.perf_counter()\n"
        "code = subprocess.call(sys.argv[1:], stdout=subprocess.DEVNULL)\n"
        "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
        "print(code, used.ru_utime + used.ru_stime, time.perf_counter() - start, used.ru_maxrss)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", probe, sys.executable, *arguments],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    code, cpu, clock, memory = done.stdout.split()
    if code not in ("0", "3"):  # a study that says of a case that it did not converge has done its work
        raise SystemExit(f"{' '.join(arguments)} ended with {code}:\n{done.stderr}")
    return float(cpu), float(clock), float(memory) / MEGABYTE


def command(*words: str) -> tuple[float, float, float]:
    """As `child`, of one of our commands that writes into a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        return child(["-m", "fe_contact", *words, "--out", folder, "--quiet"])


def against_imports(group: str, what: str, bound: float, repeats: int, words: Callable[[], list[str]]) -> Ratio:
    """CPU of one of our commands, each time against bare imports just before it; ``words`` are other ones each time."""
    samples, memory = [], 0.0
    for _ in range(repeats):
        imports = child(["-c", IMPORTS])[0]
        cpu, _, used = command(*words())
        samples.append(cpu / imports)
        memory = max(memory, used)
    return Ratio.of(group, what, samples, bound, memory)


def run_words(scene: str, tolerance: str) -> list[str]:
    """An impact at a speed that nobody used before: up to a tenth off the scene's."""
    velocity = Scene.load(scene).velocity * random.SystemRandom().uniform(0.9, 1.1)
    return ["run", scene, "--tolerance", tolerance, "--set", f"striker.velocity={velocity!r}"]


def indent_words(scene: str, deepest: float) -> list[str]:
    """Twenty depths over a decade and a half, the shallowest of them new each time."""
    shallowest = ROW_SHALLOWEST * random.SystemRandom().uniform(1.0, 1.1)
    depths = ",".join(repr(deepest * shallowest ** (share / 19.0)) for share in range(20))
    return ["indent", scene, "--depths", depths]


def runs(repeats: int) -> Iterator[Ratio]:
    """One impact, bars included, a whole process each."""
    for scene, tolerance, bound in RUNS:
        yield against_imports("run", f"{scene} at {tolerance}", bound, repeats, partial(run_words, scene, tolerance))


def indents(repeats: int) -> Iterator[Ratio]:
    """Twenty slow indentations of every row of Table 1, a whole process each."""
    for scene, deepest in ROW_DEPTHS.items():
        yield against_imports(
            "indent", f"{scene}, 20 depths", ROW_BOUND, repeats, partial(indent_words, scene, deepest)
        )


def studies(repeats: int) -> Iterator[Ratio]:
    """Whole studies; `compare` in runs of the same scene."""
    for words, bound in STUDIES:
        yield against_imports("study", " ".join(words), bound, 1, partial(list, words))
    samples = []
    for _ in range(repeats):
        alone = command(*run_words(COMPARED, "1e-3"))[0]
        samples.append(command("compare", COMPARED)[0] / alone)
    yield Ratio.of("study", f"compare {COMPARED}, in runs of it", samples, COMPARE_RUNS)


def sweeps(repeats: int) -> Iterator[Ratio]:
    """Many cases in two processes, start and table included, by the clock against the clock of bare imports."""
    for scene, method, count, bound in SWEEPS:
        samples, memory = [], 0.0
        for _ in range(min(repeats, 1)):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "sweep.toml"
                draws = f"[draws]\ncount = {count}\nseed = {random.SystemRandom().randrange(10**6)}\n"
                velocity = Scene.load(scene).velocity
                draws += f'"striker.velocity" = {{ log_uniform = [{0.5 * velocity}, {2.0 * velocity}] }}\n'
                file.write_text(f'name = "s"\nscene = "{scene}"\nmethods = ["{method}"]\n{draws}', encoding="utf-8")
                imports = child(["-c", IMPORTS])[1]
                _, clock, memory = command("sweep", str(file), "--jobs", "2")
            samples.append(clock / imports)
        yield Ratio.of("sweep", f"{count} of {scene} by {method}, clock", samples, bound, memory)


def again(repeats: int) -> Iterator[Ratio]:
    """One more impact in a process that has its meshes, bars included."""
    imports = statistics.median(child(["-c", IMPORTS])[0] for _ in range(repeats))
    for tolerance in (1e-3, 1e-4):
        spent = []
        for _ in range(MARGINAL_REPEATS + 1):
            velocity = random.SystemRandom().uniform(0.015, 0.025)
            scene = Scene.load("polymer-sphere", {"striker.velocity": velocity})
            start = time.process_time()
            fe_contact.run(scene, tolerance)
            spent.append((time.process_time() - start) / imports)
        yield Ratio.of("again", f"polymer-sphere at {tolerance:g}", spent[1:], MARGINAL_BOUND)


def lumped_laws(repeats: int) -> Iterator[Ratio]:
    """Impacts by laws, in one process: those with memory from a scene's geometry, those between two masses by k."""
    imports = statistics.median(child(["-c", IMPORTS])[0] for _ in range(repeats))
    rng = random.SystemRandom()
    for name, base in (("polymer-sphere", 0.02), ("steel-ball-sls", 1.0)):
        speeds = [base * rng.uniform(0.75, 1.25) for _ in range(LAW_SAMPLES)]
        scenes = [Scene.load(name, {"striker.velocity": speed}) for speed in speeds]
        for law, bound in LAW_BOUNDS.items():
            member = laws.get(law)
            samples = spent(scenes, lambda scene, law=member: simulate(law.of(scene), scene, LAW_TOLERANCE), imports)
            yield Ratio.of("law", f"{law}, {name}", samples, bound)
        samples = spent(scenes, lambda scene: mdr.estimate(scene, elements=70), imports)
        yield Ratio.of("law", f"mdr.estimate, {name}", samples, LAW_BOUNDS["correspondence"])
    for law in laws.available():
        member = laws.get(law)
        if "k" not in member.keys:
            continue
        keys = {"name": law, "k": 1e8, **({"e": 0.6} if "e" in member.keys else {})}
        strikers = [{"mass": rng.uniform(500.0, 2e3), "velocity": rng.uniform(0.1, 2.0)} for _ in range(LAW_SAMPLES)]
        scenes = [Scene.from_dict({"striker": striker, "law": keys}) for striker in strikers]
        samples = spent(scenes, lambda scene, law=member: law.of(scene).simulate(scene, FORCE_TOLERANCE), imports)
        yield Ratio.of("law", law, samples, FORCE_BOUND)


def spent(scenes: list[Scene], answer: Callable[[Scene], object], imports: float) -> list[float]:
    """CPU of each answer but the first, which fills what is kept, in bare imports."""
    found = []
    for scene in scenes:
        start = time.process_time()
        answer(scene)
        found.append((time.process_time() - start) / imports)
    return found[1:]


def ting(repeats: int) -> Iterator[Ratio]:
    """Ting's law asked again and again for other materials, as `identify` does."""
    imports = statistics.median(child(["-c", IMPORTS])[0] for _ in range(repeats))
    rng, total, law = random.SystemRandom(), 0.0, laws.get("ting")
    for _ in range(TING_STUDY):
        scene = Scene.load("polymer-sphere", {"target.material.C1": 1.8e4 * rng.uniform(0.1, 10.0)})
        start = time.process_time()
        simulate(law.of(scene), scene, 1e-3)
        total += time.process_time() - start
    yield Ratio.of("law", f"ting, {TING_STUDY} materials", [total / imports], TING_BOUND)


GROUPS: dict[str, Callable[[int], Iterator[Ratio]]] = {
    "runs": runs, "indents": indents, "studies": studies, "sweeps": sweeps,
    "again": again, "laws": lumped_laws, "ting": ting,
}  # fmt: skip


def counted() -> dict[str, dict[str, int]]:
    """Work of one run of each scene at its default tolerance, the same on every machine."""
    return {name: dict(fe_contact.run(Scene.load(name)).work) for name in COUNTED}


def table(ratios: list[Ratio]) -> str:
    """The README's rows: of slow indentations and of laws the dearest alone."""
    dearest = {one.group: one.what for one in sorted(ratios, key=lambda one: one.median) if one.group in MANY}
    shown = [one for one in ratios if dearest.get(one.group, one.what) == one.what]
    rows = [
        f"| {one.group}: {one.what}{MANY.get(one.group, '')} | {one.median:.3g} | {one.bound:.3g} |\n" for one in shown
    ]
    return "| cost in bare imports | measured | goal |\n|---|---|---|\n" + "".join(rows)


def recorded() -> tuple[list[Ratio], dict[str, dict[str, int]]]:
    """What was measured last, and the work counted then."""
    if not RECORD.exists():
        return [], {}
    known = json.loads(RECORD.read_text(encoding="utf-8"))
    return [Ratio(**one) for one in known["ratios"]], known["work"]


def keep(ratios: list[Ratio], work: dict[str, dict[str, int]]) -> None:
    """The record, older ratios that were not measured now included, and the README's table."""
    merged = {(one.group, one.what): one for one in [*recorded()[0], *ratios]}
    known = {"ratios": [asdict(one) for one in merged.values()], "work": work}
    RECORD.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    text = README.read_text(encoding="utf-8")
    README.write_text(TABLE.sub(lambda _: table(list(merged.values())), text), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("groups", nargs="*", choices=[*GROUPS, []], metavar="GROUP", help=", ".join(GROUPS))
    parser.add_argument("--repeats", type=int, default=REPEATS)
    parser.add_argument("--record", action="store_true", help="keep what is measured, and write the README's table")
    asked = parser.parse_args()
    os.environ["FE_CONTACT_CACHE"] = "off"
    for package in PACKAGES:
        compileall.compile_dir(ROOT / package, quiet=1)
    older, work_before = recorded()
    known = {(one.group, one.what): one for one in older}
    ratios = []
    for group in asked.groups or GROUPS:
        for ratio in GROUPS[group](asked.repeats):
            sys.stdout.write(ratio.line(known.get((ratio.group, ratio.what))) + "\n")
            sys.stdout.flush()
            ratios.append(ratio)
    work = counted()
    for name, now in work.items():
        before = work_before.get(name, now)
        changed = ", ".join(f"{key} {before.get(key)} -> {now[key]}" for key in now if before.get(key) != now[key])
        sys.stdout.write(f"work       {name:46} {changed or 'as recorded' if work_before else now}\n")
    if asked.record:
        keep(ratios, work)


if __name__ == "__main__":
    main()
