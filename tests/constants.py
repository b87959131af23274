"""Constants on the way to an error bar: what each one is, and, where it is measured, what it covers.

`python tests/constants.py` prints the table of fe_contact/manual/error_bars.md (`--write` puts it there).
`python tests/constants.py --measure N` solves N seeded impacts of every kind of tests/fe/test_bars_everywhere.py with
each measured constant as it is and weaker, and prints what lies outside its bar.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

PAGE = Path(__file__).parents[1] / "fe_contact" / "manual" / "error_bars.md"
BEGIN = "| constant | value | kind | why |\n|---|---|---|---|\n"
KINDS, TOLERANCES = ("ball", "profile", "flat", "layer", "early_end"), (1e-1, 1e-2, 1e-3)
SEED = 1123

DERIVED, MEASURED, WORK = "derived", "measured", "no bar depends on it"


class Constant(NamedTuple):
    """A constant by module and name; ``weaker``: the value that `--measure` tries beside it."""

    module: str
    name: str
    kind: str
    why: str
    weaker: Any = None


CERTIFY, COMPARE = "fe_contact.budget.certify", "fe_contact.studies.compare.study"
VARIATION, CURVE, IMPACT = "fe_contact.budget.variation", "fe_contact.budget.curve", "fe_contact.march.impact"
TABLE = (
    Constant(VARIATION, "SAFETY", DERIVED, "Roache's for three grids, doi:10.1115/1.2910291"),
    Constant(CERTIFY, "LEAST_ORDER", DERIVED, "a penalty errs as its inverse, a far field as the inverse square"),
    Constant(
        CERTIFY,
        "MESH_ORDER",
        DERIVED,
        "the least of what elements promise at an edge that follows the contact; orders one and two lock",
    ),
    Constant(CERTIFY, "WITNESS", DERIVED, "of elements that lock those of twice the order tell, see UNORDERED"),
    Constant(CERTIFY, "WITNESS_ELEMENTS", MEASURED, "of them along the contact radius, at least"),
    Constant(CERTIFY, "MESH_ORDER_ANYWHERE", DERIVED, "pressure's root at an edge within an element"),
    Constant(CERTIFY, "NEAR_ANYWHERE", MEASURED, "TOP of what such a mesh changes of the path", 0.998),
    Constant(CERTIFY, "DAMPED_ANYWHERE", MEASURED, "weights of a mesh that stays under a dashpot, which jitters", {}),
    Constant(CERTIFY, "NODEWISE_ANYWHERE", MEASURED, "the same of exact enforcement, by whole nodes", {}),
    Constant(CERTIFY, "DAMPED_SINCE", MEASURED, "LATE of what such a mesh changes, by chance little at the end", 0.75),
    Constant(CERTIFY, "LEAST_HALVED", MEASURED, "fewer steps are doubled instead of halved", 10),
    Constant(CERTIFY, "LEAST_HALVED_SETTING", MEASURED, "coarser settings are doubled instead of halved"),
    Constant(CERTIFY, "UNSEEN", MEASURED, "first steps of the coarsest run in which no order shows", 0),
    Constant(CERTIFY, "KEPT", MEASURED, "left of the steps' change by branches as fast as a step, in their share", {}),
    Constant(CERTIFY, "KEPT_OF_FORCE", MEASURED, "the same of the force", 0.0),
    Constant(CERTIFY, "FALLS", MEASURED, "jitter that half the step leaves by less than this is the step's", 1e9),
    Constant(CERTIFY, "ROWS_ORDER", DERIVED, "three of the five between rows, where a quarter of them shows it"),
    Constant(CERTIFY, "MOST_APART", MEASURED, "durations that tell of one and the same end", 1e9),
    Constant(CERTIFY, "ROUNDING", MEASURED, "of a solve of nearly incompressible bodies", 0.0),
    Constant(CERTIFY, "MARCHES", WORK, "what a budget costs"),
    Constant(VARIATION, "FIRST_ORDER", DERIVED, "SAFETY over 2^1 - 1"),
    Constant(VARIATION, "UNORDERED", DERIVED, "SAFETY times two: an order of 0.6 is supposed", 1.25),
    Constant(VARIATION, "AT_TOUCH", DERIVED, "SAFETY over 2^(1/2) - 1"),
    Constant(VARIATION, "TOP", MEASURED, "depth and time of a peak are judged by all above this share", 1.0),
    Constant(VARIATION, "STEEPER", MEASURED, "slope of a change over its chord, at a peak under a flat end", 0.5),
    Constant(
        VARIATION,
        "RIPPLED",
        MEASURED,
        "slope or size of a rippling change over its quartic's at a peak",
        0.5,
    ),
    Constant(VARIATION, "FEWEST", WORK, "steps that the curve of a jittering force keeps"),
    Constant(VARIATION, "SMOOTHING", MEASURED, "a change that crosses zero is that of its neighbours", 0.0),
    Constant(CERTIFY, "AS_EXPECTED", MEASURED, "ratio of changes over the expected one that shows the order", (0, 1e9)),
    Constant(CERTIFY, "ABOUT", MEASURED, "the same that shows it about", (0.0, 1e9)),
    Constant(CERTIFY, "ASYMPTOTIC", MEASURED, "error of the duration with the fewest steps where orders count", 1e9),
    Constant(CERTIFY, "NEARLY", MEASURED, "share of the expected ratio that durations must show", 0.0),
    Constant(
        CERTIFY,
        "ABOUT_A_STEP",
        DERIVED,
        "step over relaxation time; outside, the branch's weight is within 1/8 of a power of the step",
        (1e300, 1e301),
    ),
    Constant(CURVE, "BEGUN", DERIVED, "rounding: 1e-24 of the contact time, where no load has a share of any force"),
    Constant(CURVE, "FIRST", DERIVED, "steps: polynomials through six nodes tell what relaxes later"),
    Constant(CURVE, "RISING", DERIVED, "of the first step: of what rises in it exp(-20) is left at its end"),
    Constant(COMPARE, "CURVE_ORDER", DERIVED, "slopes of parabolas through three depths of a slow curve"),
    Constant(CURVE, "PEAK_SHARE", MEASURED, "a peak is judged by all forces above this share", 1.0),
    Constant(CURVE, "HALF_AS_HIGH", DERIVED, "a quartic places a peak to the fourth order of the width that it fits"),
    Constant(VARIATION, "LATE", MEASURED, "path and speed from here on count for those at the end", 1.0),
    Constant(CURVE, "EARLIEST", WORK, "rows that tell where a curve is read"),
    Constant(IMPACT, "PREDICTIONS", MEASURED, "their spread is that of the end", 1),
    Constant(IMPACT, "NOISE", MEASURED, "share of the peak below which contact may be lost in the mesh"),
    Constant(IMPACT, "FAINT", MEASURED, "share of the peak below which a kink may be the end"),
    Constant(IMPACT, "SETTLED", MEASURED, "of the tolerance: what still swings of a weight at rest"),
    Constant(IMPACT, "LONGEST", MEASURED, "mean steps that a weight which swings may be stepped over"),
    Constant(IMPACT, "AT_REST", MEASURED, "share of the velocity at which a fluid has stopped a striker"),
    Constant(IMPACT, "REST_GROWTH", DERIVED, "between rows at rest six of them tell 1/t to 1e-6"),
    Constant(IMPACT, "STEPS_ALLOWED", WORK, "after which a march gives up"),
    Constant("fe_contact.waves.certify", "ORDER", DERIVED, "contact that begins point by point has order one"),
    Constant("fe_contact.waves.certify", "LEAST_NODES", MEASURED, "along the contact radius; fewer are doubled"),
    Constant("fe_contact.waves.certify", "TRUSTED", DERIVED, "two of the five orders between rows"),
    Constant("fe_contact.dynamics.flow", "SETTLED", MEASURED, "out of balance in flow; a force moves by a third of it"),
    Constant("fe_contact.solids.sharp_rim", "ORDERS", MEASURED, "of small strains; 0.58 is the least that shows"),
    Constant("fe_contact.solids.sharp_rim", "SHOWN", MEASURED, "beyond it a body has folded under one of three edges"),
    Constant("fe_contact.relaxing_punch", "SECOND_ORDER", DERIVED, "of two ways to no edge, by twice the power"),
    Constant("fe_contact.plastic.settling", "SETTLED", MEASURED, "without inertia; with 1e-7 a force moves by 3e-6"),
    Constant(
        "fe_contact.studies.finite_length", "CORNER", DERIVED, "stress where a free end meets a base: no order more"
    ),
    Constant(
        "fe_contact.studies.finite_length", "ACCOMPANYING", MEASURED, "of one depth alone, a bar may be by chance small"
    ),
    Constant("lumped.laws._hereditary", "SAFETY", MEASURED, "of two integrations with more and with fewer nodes"),
    Constant("lumped.laws._hereditary", "LOCAL_SHARE", WORK, "what a piece may err"),
    Constant("lumped.laws.ting", "ROWS", MEASURED, "half as many change the bar by 0.02 of it, and SAFETY adds half"),
    Constant("lumped.laws.ting", "LOOKS", MEASURED, "four times as many change the bar by 0.02 of it"),
    Constant("lumped.laws._assembly", "ROUNDING", DERIVED, "of sums of some thousand terms"),
    Constant("lumped.laws._assembly", "LEAST_SHARE", MEASURED, "two integrations may agree in a number by chance"),
    Constant("lumped.laws.mdr", "SAFETY", MEASURED, "of a limit of three marches beside that of two"),
    Constant("lumped.solvers.point.half_widths", "SAFETY", MEASURED, "of first-order estimates told at some points"),
    Constant("lumped.numbers", "ROUNDED_TIME", DERIVED, "of times that are sums of hundreds of steps, and of flights"),
    Constant("lumped.pounding.study", "BETWEEN_POINTS", DERIVED, "of a polynomial over a sixth of a period"),
)


def table() -> str:
    """The table of all constants, with the values that the code has, as Markdown."""
    return BEGIN + "".join(_row(one) for one in TABLE)


def _row(one: Constant) -> str:
    place = f"`{one.module.removeprefix('fe_contact.')}.{one.name}`"
    return f"| {place} | {value(one)!r} | {one.kind} | {one.why} |\n"


def value(one: Constant) -> Any:
    """What the code has."""
    return getattr(importlib.import_module(one.module), one.name)


def write() -> None:
    """Put the table into the page, in the place of the one that is there."""
    page = PAGE.read_text()
    before, rest = page.split(BEGIN)
    after = rest.lstrip().split("\n\n", 1)[1] if "\n\n" in rest else ""
    PAGE.write_text(before + table() + ("\n" + after if after else ""))


def measure(count: int) -> None:
    """Print, for each constant with a weaker value, the worst error over its bar and the cases outside, both ways."""
    sys.path.insert(0, str(Path(__file__).parent / "fe"))
    everywhere = importlib.import_module("test_bars_everywhere")
    random = np.random.default_rng(SEED)
    cases = [(everywhere.KINDS[kind](random), tol) for _ in range(count) for kind in KINDS for tol in TOLERANCES]
    said("as it is", _outside(everywhere, cases))
    for one in TABLE:
        if one.weaker is not None:
            kept = value(one)
            for module in [m for name, m in sys.modules.items() if name.startswith(("fe_contact", "lumped"))]:
                if getattr(module, one.name, None) is kept:
                    setattr(module, one.name, one.weaker)
            said(f"{one.module}.{one.name} = {one.weaker!r}", _outside(everywhere, cases))
            for module in [m for name, m in sys.modules.items() if name.startswith(("fe_contact", "lumped"))]:
                if getattr(module, one.name, None) is one.weaker:
                    setattr(module, one.name, kept)


def _outside(everywhere: Any, cases: list[Any]) -> list[float]:
    """Largest error over bar of every case that converges."""
    found = [everywhere.judged(scene, tolerance) for scene, tolerance in cases]
    return [max(e / one.bars[n] for n, e in one.errors.items()) for one in found if one is not None and one.converged]


def said(what: str, ratios: list[float]) -> None:
    """One line on the terminal."""
    over = sum(not ratio <= 1.0 for ratio in ratios)
    sys.stdout.write(f"{what}: {over} of {len(ratios)} outside, worst error over bar {max(ratios):.2f}\n")
    sys.stdout.flush()


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--write", action="store_true", help="put the table into the manual's page")
    parser.add_argument("--measure", type=int, metavar="N", help="solve N impacts of every kind and tolerance")
    asked = parser.parse_args()
    if asked.write:
        write()
    elif asked.measure:
        measure(asked.measure)
    else:
        sys.stdout.write(table())


if __name__ == "__main__":
    main()
