"""How many small falsifications of the numerical core the tests notice. A script, not a test.

    python tests/mutants.py [--seed N] [--count 150] [--jobs 2] [--budget 20] [--only PATTERN ...] [--work FOLDER]

Draws mutants of the syntax trees of the ``CORE``, every file alike: a number ten times larger or smaller, an order one
more or less, a comparison turned round, a condition held, largest for smallest, a sum for a difference, a factor left
out, an answer a tenth, a bar a fifteenth. Numbers below ``FLOOR``, or above its inverse, stay: they guard a division.
Each mutant is written to a copy of the checkout, never to the checkout, and meets the tests that reach the mutated
line, those first that killed others of its file, then the fastest, until one fails, up to ``--budget`` seconds of
processor time. Prints what every mutant met, the survivors, those that do no harm with their reason (``HARMLESS``),
and the share killed, of all and of those that could do harm: survivors that stand in ``HARMLESS`` left out.

Which test reaches what is found by running every test file once in such a copy, where what fails is not asked. It is
kept in the folder ``--work``; so are the answers, so that a run that was broken off goes on where it stood. A test file
or a source that changes is asked again, and a changed function of all tests that call it. Quickest from Python 3.12 on.
"""

from __future__ import annotations

import argparse
import ast
import copy
import gc
import hashlib
import json
import multiprocessing
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import _lru_cache_wrapper, cache, cached_property
from itertools import accumulate
from pathlib import Path
from queue import SimpleQueue
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("lumped", "meshes", "fe_contact")
ERRORS = (
    "fe_contact/budget/*.py", "fe_contact/march/*.py", "fe_contact/indentation.py", "fe_contact/reference.py",
    "fe_contact/contact/problem.py", "fe_contact/steppers/*.py", "fe_contact/waves/certify.py",
    "fe_contact/waves/impact.py", "fe_contact/contact/enforcement/corrected.py",
    "fe_contact/contact/enforcement/exact.py", "fe_contact/plastic/impact.py", "fe_contact/relaxing_impact.py",
    "fe_contact/relaxing_punch.py",
)  # fmt: skip
CORE = (
    *ERRORS, "fe_contact/bodies/*.py", "fe_contact/steppers/*.py", "fe_contact/contact/enforcement/*.py",
    "fe_contact/schemes/*.py", "fe_contact/assembly/far_field.py", "fe_contact/targets/layer.py",
    "fe_contact/waves/*.py", "fe_contact/plastic/*.py", "fe_contact/solids/*.py", "fe_contact/large_strains.py",
    "fe_contact/dynamics/*.py", "fe_contact/studies/finite_length.py",
    "lumped/solvers/hereditary/*.py", "lumped/solvers/point/*.py", "lumped/solvers/mdr/*.py",
    "lumped/solvers/rod.py", "lumped/solvers/radau.py", "lumped/paper/table1.py", "lumped/laws/_hereditary*.py",
    "lumped/laws/mdr.py", "lumped/laws/correspondence.py", "lumped/laws/_assembly.py", "lumped/laws/_force_law.py",
    "lumped/laws/*_waves.py", "lumped/indentation.py", "lumped/result/history.py",
)  # fmt: skip
TESTS = (
    "tests/fe/test_*.py", "tests/lumped/test_*.py", "tests/test_table1.py", "tests/test_stability*.py",
    "tests/test_compare_targets.py",
)  # fmt: skip
LONGEST = 5.0  # s of processor time, watched: a slower test is not asked
FLOOR = 1e-30  # below any number that physics or rounding asks for, as its inverse is above
FEW = 8  # integers up to here are orders and numbers of things, larger ones are bounds
SILENT = ("progress", "count", "counted", "warn", "lru_cache", "reshape")  # calls whose arguments change no answer

# Mutants that do no harm, by pattern of the file, function or constant, and how the change begins.
BEGINS = "a setting to begin with: its error is in the bar, and refined where that is too wide"
GUESS = "a first guess or a trial, whose outcome is checked"
WORK = "how much work is done, or told, before the same answer"
HARMLESS: dict[tuple[str, str, str], str] = {
    # settings to begin with: what they err by is in the bar, and refined where that is too wide
    ("fe_contact/budget/plan.py", "_elements", ""): BEGINS,
    ("fe_contact/budget/plan.py", "VISCOUS_ORDER", ""): BEGINS,
    ("fe_contact/plastic/indent.py", "indent", "asked.min()"): BEGINS,
    ("fe_contact/plastic/impact.py", "PILOT", ""): BEGINS,
    ("fe_contact/plastic/impact.py", "PILOT_FIRST", ""): BEGINS,
    ("fe_contact/plastic/impact.py", "MOST_PILOT", ""): WORK,
    ("fe_contact/plastic/impact.py", "Rebound.march", "1 -> 0"): WORK,
    ("fe_contact/budget/plan.py", "scales", "if grows_once"): BEGINS,
    ("fe_contact/budget/runs.py", "PLACED", ""): BEGINS,
    ("fe_contact/budget/runs.py", "Runs._piloted", ""): BEGINS,
    ("fe_contact/steppers/struck.py", "FixedContact._solved", "self.numerics.penalty"): BEGINS,
    ("fe_contact/march/impact.py", "share_of_rest", ""): BEGINS,
    ("fe_contact/budget/plan.py", "FLAT_STEPS", ""): BEGINS,
    ("fe_contact/budget/plan.py", "FLAT_ORDER", ""): BEGINS,
    ("fe_contact/budget/plan.py", "_flat_steps", ""): BEGINS,
    ("fe_contact/budget/plan.py", "COARSE", ""): BEGINS,
    ("fe_contact/budget/plan.py", "_alike", ""): BEGINS,
    ("fe_contact/budget/runs.py", "Runs._placed", ""): BEGINS,
    ("fe_contact/waves/plan.py", "DEFAULT_TOLERANCE", ""): BEGINS,
    (
        "fe_contact/waves/targets/_block.py",
        "DEFAULT_TOLERANCE",
        "",
    ): "a default that every result tells beside its bars",
    ("fe_contact/waves/plan.py", "placed", ""): BEGINS,
    ("fe_contact/settings.py", "WaveNumerics.finer", ""): BEGINS,
    ("fe_contact/waves/balls.py", "flying", ""): BEGINS,
    ("fe_contact/waves/targets/_block.py", "_steps", ""): BEGINS,
    ("fe_contact/waves/targets/_block.py", "STEPS, MANY, MOST", "200 ->"): BEGINS,
    ("fe_contact/waves/targets/*.py", "plan", ""): BEGINS,
    ("fe_contact/waves/targets/half_space.py", "_slowest", ""): BEGINS,
    ("fe_contact/waves/targets/layer.py", "_stiffness", ""): BEGINS,
    ("fe_contact/waves/targets/layer.py", "_far_radius", ""): BEGINS,
    ("fe_contact/waves/targets/layer.py", "LEAST", ""): BEGINS,
    ("fe_contact/budget/plan.py", "AT_TOUCH", ""): BEGINS,
    ("fe_contact/budget/runs.py", "PILOT_STEPS", ""): BEGINS,
    ("fe_contact/budget/plan.py", "scales", "if not geometry"): BEGINS,
    ("fe_contact/budget/plan.py", "WIDTHS", ""): BEGINS,
    ("fe_contact/waves/targets/sphere.py", "moving", "min(balls"): BEGINS,
    ("fe_contact/budget/plan.py", "_stiffness", "if has_curve"): BEGINS,
    ("fe_contact/budget/plan.py", "_stiffness", "modulus *"): BEGINS,
    ("fe_contact/budget/runs.py", "Runs.placed", ""): BEGINS,
    ("fe_contact/budget/plan.py", "_answer", ""): BEGINS,
    ("fe_contact/budget/plan.py", "half_space_stiffness", ""): BEGINS,
    ("fe_contact/budget/plan.py", "_finer", ""): BEGINS,
    ("fe_contact/budget/plan.py", "FINER", ""): BEGINS,
    ("fe_contact/budget/plan.py", "DEFAULTS", "1000.0 -> 10000"): "a stiffer penalty errs by less, and costs nothing",
    ("lumped/laws/rod_waves.py", "COARSEST, FINEST, FINER", ""): BEGINS,
    ("lumped/solvers/hereditary/march.py", "Stretch._error", "tail(values[self.force])"): BEGINS,
    ("fe_contact/budget/runs.py", "PLACINGS", ""): BEGINS,
    ("fe_contact/waves/plan.py", "LOOSER", ""): BEGINS,
    ("fe_contact/relaxing_impact.py", "plan", ""): BEGINS,
    ("fe_contact/relaxing_impact.py", "ELEMENTS", ""): BEGINS,
    ("fe_contact/indentation.py", "SCOUTING, SCOUTING_ORDER", "2 -> 3"): BEGINS,
    ("fe_contact/budget/certify.py", "certify", "4 -> "): BEGINS,
    # a guess that Newton's method, a secant or a check of every step corrects
    ("fe_contact/contact/problem.py", "_answered", "springs * lifted ->"): GUESS,
    ("fe_contact/contact/problem.py", "_Point.towards", ""): GUESS,
    ("fe_contact/contact/enforcement/exact.py", "enforce", "0.5"): GUESS,
    ("fe_contact/steppers/scaled_surface.py", "Stepper._overlap_radius", ""): GUESS,
    ("fe_contact/march/impact.py", "time_left", "2 -> 3"): GUESS,
    ("fe_contact/march/impacts.py", "_fallen", "2.0"): GUESS,
    ("fe_contact/budget/curve.py", "_stationary", "12 -> "): GUESS,
    ("fe_contact/budget/curve.py", "_stationary", "6 -> "): GUESS,
    ("fe_contact/contact/enforcement/exact.py", "_solution", ""): GUESS,
    ("fe_contact/contact/enforcement/exact.py", "enforce", "reach @"): GUESS,
    ("fe_contact/contact/enforcement/exact.py", "enforce", "1 ->"): WORK,
    ("fe_contact/contact/enforcement/exact.py", "independent", "a tenth"): "a basis, whatever its scale",
    ("lumped/solvers/mdr/march.py", "CONVERGED", "1e-09 -> 1e-10"): GUESS,
    ("lumped/solvers/mdr/nest.py", "Nest.level", "0.0"): GUESS,
    ("fe_contact/waves/targets/rod.py", "Dent.enforce", "signed > 0.0"): GUESS,
    ("lumped/solvers/mdr/nest.py", "pace_of", ""): GUESS,
    ("lumped/solvers/point/contact.py", "contact", "tolerance **"): GUESS,
    ("lumped/solvers/radau.py", "Nodes._longer", ""): GUESS,
    ("lumped/solvers/point/bodies.py", "Step.accelerations", ""): GUESS,
    ("lumped/solvers/hereditary/closing.py", "Guess.of", ""): GUESS,
    ("lumped/solvers/hereditary/march.py", "Stretch.march", "span[1] - span[0]"): GUESS,
    ("lumped/solvers/mdr/march.py", "_next", ""): GUESS,
    ("lumped/solvers/mdr/march.py", "_inward", ""): GUESS,
    ("lumped/solvers/mdr/nest.py", "coarse_beyond", "2.0 * NEAR"): GUESS,
    ("fe_contact/steppers/struck.py", "FIRST", ""): GUESS,
    ("fe_contact/steppers/struck.py", "LEAST_KEPT", ""): GUESS,
    ("fe_contact/steppers/scaled_surface.py", "COARSE", ""): GUESS,
    ("fe_contact/steppers/scaled_surface.py", "EDGE", "1e-09 ->"): "an edge but for rounding",
    ("fe_contact/steppers/scaled_surface.py", "POINTS_A_STEP", "8 -> 9"): WORK,
    ("fe_contact/steppers/scaled_surface.py", "Stepper._guesses", "1.0 ->"): GUESS,
    ("fe_contact/steppers/scaled_surface.py", "Stepper._guesses", "if len(steps)"): GUESS,
    ("lumped/solvers/point/memory.py", "StepLoad.tangents", ""): GUESS,
    ("fe_contact/steppers/struck.py", "FixedContact._guesses", ""): GUESS,
    # how much work is done, or told, before the same answer
    ("fe_contact/waves/line.py", "STEP", ""): WORK,
    ("lumped/solvers/point/phase.py", "solved", "size <= ROUNDING * scale or"): WORK,
    ("fe_contact/reference.py", "MOST_STEPS", ""): WORK,
    ("fe_contact/budget/runs.py", "Runs._placed", "if number not in"): WORK,
    ("fe_contact/budget/certify.py", "MARCHES", ""): WORK,
    ("fe_contact/budget/certify.py", "certify", "MARCHES"): WORK,
    ("fe_contact/march/impact.py", "FAINT", "0.001 -> 0.0001"): WORK,
    ("fe_contact/budget/runs.py", "AnyRuns.curve", "if settings not in"): WORK,
    ("fe_contact/waves/certify.py", "cost_of", ""): WORK,
    ("fe_contact/steppers/scaled_surface.py", "_stresses", "if step.radius > edge -> True"): WORK,
    ("fe_contact/waves/line.py", "Doubling.finer", ""): WORK,
    ("fe_contact/steppers/struck.py", "SECANTS, PRECISE", "20 ->"): WORK,
    ("fe_contact/contact/problem.py", "ROOM", ""): WORK,
    ("fe_contact/steppers/struck.py", "FixedContact._by_secants", "solves +"): WORK,
    ("fe_contact/steppers/struck.py", "FixedContact._at_once", "1 ->"): WORK,
    ("fe_contact/contact/enforcement/augmented.py", "SLOW, STIFFER, STIFFEST", ""): WORK,
    (
        "fe_contact/contact/enforcement/augmented.py",
        "SETTLED",
        "1e-08 -> 1e-09",
    ): "updates more of the same answer, to 2e-8 of its largest pressure",
    ("fe_contact/plastic/path.py", "Presser._released", "1.0 -> 10"): GUESS,
    ("fe_contact/reference.py", "ROUNDS", "4 -> 5"): WORK,
    ("fe_contact/budget/certify.py", "_trusted_order", "1.0 -> 10"): "a factor of errors, while changes are asked",
    ("lumped/solvers/rod.py", "TippedImpact.pieces", "1.0 -> 0.1"): "the sign of a direction",
    ("lumped/result/history.py", "densified", "FIRST * (t[-1] - t[0]) ->"): "1e-150 of any time is none",
    ("lumped/solvers/hereditary/rebound.py", "Trial.change_of_lack", ""): GUESS,
    ("lumped/solvers/hereditary/closing.py", "close", "0 -> -1"): WORK,
    ("lumped/laws/_assembly.py", "FINEST_ROWS", "1e-09 -> 1e-10"): WORK,
    ("fe_contact/waves/targets/rod.py", "MOST_MESHED", "100000 -> 200000"): WORK,
    ("fe_contact/bodies/pressing.py", "ScaledStill.press", "attempt * solves"): WORK,
    ("fe_contact/reference.py", "_too_dear", "longer * wider"): WORK,
    ("fe_contact/reference.py", "_too_dear", "3 ->"): WORK,
    ("fe_contact/waves/plan.py", "BYTES, AT_LEAST", ""): WORK,
    ("fe_contact/waves/targets/rod.py", "run", "len(found.samples) - 1"): WORK,
    ("fe_contact/indentation.py", "BISECTIONS", "40 -> 80"): WORK,
    ("fe_contact/indentation.py", "ROUNDS", ""): WORK,
    ("fe_contact/contact/enforcement/exact.py", "SURFACES_KEPT", ""): WORK,
    ("fe_contact/waves/plan.py", "JUDGED", ""): WORK,
    ("fe_contact/solids/base.py", "DIRECTIONS", "16 -> 32"): WORK,
    ("fe_contact/solids/pressing.py", "NEAREST", "0.02 -> 0.002"): WORK,
    ("fe_contact/solids/newton.py", "_descending", "MOST_ITERATIONS + 1 ->"): WORK,
    ("fe_contact/solids/newton.py", "_descending", "1 ->"): WORK,
    ("lumped/laws/_assembly.py", "FINEST_ROWS", ""): WORK,
    (
        "lumped/laws/_assembly.py",
        "AROUND",
        "17 -> 8",
    ): "fewer places of a parabola: a bar that is wider by a thousandth",
    ("lumped/laws/_assembly.py", "_NearPeak.of", "0.0 -> 0.1"): "the width of what is not looked at",
    ("fe_contact/contact/problem.py", "moved", "0 -> -1"): GUESS,
    ("lumped/solvers/mdr/march.py", "_rate", "if wider -> True"): "no width is nothing, whatever it yields",
    ("fe_contact/dynamics/march.py", "KEPT", ""): WORK,
    ("lumped/solvers/hereditary/closing.py", "shut", "0 ->"): WORK,
    ("lumped/solvers/hereditary/march.py", "SHORTEST, SAME", ""): WORK,
    ("lumped/solvers/hereditary/march.py", "POINTS", ""): WORK,
    ("lumped/solvers/hereditary/march.py", "MOST_PIECES", ""): WORK,
    ("lumped/solvers/hereditary/march.py", "GROWTH, SHRINKAGE, CAUTION", "0.15 ->"): WORK,
    ("lumped/laws/bar_waves.py", "BEFORE", ""): "how far before a jump, in rounding",
    ("lumped/laws/_assembly.py", "EQUAL", ""): "below what any result is asked for",
    ("lumped/laws/bar_waves.py", "_answer", "fall.knots[1:] * (1.0 - BEFORE) ->"): WORK,
    ("lumped/solvers/hereditary/approach.py", "FAINT", "0.001 -> 0.0001"): WORK,
    ("lumped/solvers/hereditary/path.py", "Path._basis", "if len"): WORK,
    ("lumped/solvers/hereditary/rebound.py", "ReboundPieces._solved", "1 ->"): WORK,
    ("lumped/laws/bar_waves.py", "of", "0.0 -> 0.1"): "of a density that there is not: every bar has one",
    ("lumped/laws/correspondence.py", "solve", "if before and"): GUESS,
    (
        "lumped/solvers/hereditary/problem.py",
        "SHALLOW, WHOLE",
        "1e-09 -> 1e-10",
    ): "shallower, where powers of layers too are told better",
    ("fe_contact/plastic/impact.py", "Rebound.deepest", "50 ->"): WORK,
    ("fe_contact/steppers/flat_end.py", "FlatStepper.shortest", "1e-07 -> 1e-08"): WORK,
    (
        "fe_contact/steppers/flat_end.py",
        "FlatStepper.shortest",
        "1e-07 -> 1e-06",
    ): "an end to 3e-10 of the contact, a tenth of its bar where most is asked for",
    (
        "fe_contact/bodies/modes.py",
        "Modes.stiffness",
        "if not places[0] <= place <= places[-1] or place in places -> True",
    ): WORK,
    ("fe_contact/steppers/struck.py", "FixedStepper.shortest", "0.0002 -> 2e-05"): WORK,
    ("fe_contact/steppers/scaled_surface.py", "Stepper.shortest", "0.0003 -> 3e-05"): WORK,
    ("fe_contact/budget/plan.py", "plan", "if _flat"): BEGINS,
    ("fe_contact/schemes/galerkin.py", "SERIES_BELOW", "0.02 -> 0.002"): "either formula errs by 2e-14 there",
    ("lumped/solvers/hereditary/march.py", "Stretch.march", "SHORTEST *"): WORK,
    ("fe_contact/solids/pressing.py", "ROUNDING", "1e-13 -> 1e-12"): WORK,
    ("fe_contact/reference.py", "MOST_OPERATIONS", ""): WORK,
    ("fe_contact/waves/line.py", "MOST_WORK", ""): WORK,
    ("fe_contact/march/impacts.py", "MOST_STEPS", ""): WORK,
    ("fe_contact/march/impacts.py", "FAINTEST", ""): WORK,
    ("fe_contact/waves/plan.py", "FLIGHT", ""): WORK,
    ("lumped/solvers/hereditary/pieces.py", "Pieces.solved", "NEWTON_STEPS"): WORK,
    ("lumped/solvers/mdr/march.py", "_to_turn", ""): GUESS,
    ("lumped/solvers/hereditary/rebound.py", "ReboundPieces._solved", "if ascends -> True"): WORK,
    ("fe_contact/budget/plan.py", "SOONEST_PEAK", ""): BEGINS,
    ("fe_contact/budget/plan.py", "_stays", ""): BEGINS,
    ("fe_contact/steppers/steps.py", "coming_square", ""): GUESS,
    ("fe_contact/contact/problem.py", "_descended", "2 ->"): GUESS,
    ("fe_contact/contact/enforcement/exact.py", "enforce", "contact.MAX_ITERATIONS"): WORK,
    ("fe_contact/contact/enforcement/augmented.py", "enforce", "SLOW * last"): WORK,
    ("fe_contact/reference.py", "_expected", ""): WORK,
    ("fe_contact/budget/budget.py", "TotalWork.of", ""): WORK,
    ("fe_contact/waves/plan.py", "Cost.bytes", ""): WORK,
    ("fe_contact/steppers/stacked.py", "_together", "a tenth"): "the unit of moduli that are divided again",
    (
        "fe_contact/reference.py",
        "check_target",
        "if not fixed and",
    ): "of a target that there is not: none is without both",
    # bounds and examples of files
    ("lumped/paper/table1.py", "LAYER", ""): "the datum that a study takes where a table names none",
    ("lumped/paper/table1.py", "ROWS", ""): "the body that a study takes where a file names none",
    # the same but for rounding, or a bar that is wider and never narrower
    ("fe_contact/waves/line.py", "_largest", "2.0 "): "how far beside a row, in rounding",
    ("fe_contact/waves/line.py", "_largest", "1.0 ->"): "how far beside a row, in rounding",
    ("lumped/result/history.py", "densified", "t[1:][rough] - start"): "how far beside a step, in rounding",
    (
        "fe_contact/waves/line.py",
        "_largest",
        "ROUNDING * end * np",
    ): "either side of a row, which its neighbour looks at",
    ("fe_contact/waves/line.py", "_largest", "np.stack"): "either side of a row, which its neighbour looks at",
    ("fe_contact/waves/line.py", "_largest", "COMPARED - 1 -> COMPARED + 1"): "the place beside, well within AWAY",
    ("fe_contact/waves/line.py", "_largest", "1 ->"): "the place beside, well within AWAY",
    ("fe_contact/waves/certify.py", "_smoothed", "rows[min(number + REACH"): "another smoothing, about as wide",
    ("fe_contact/waves/certify.py", "_smoothed", "x / np.abs"): "the unit of a polynomial's places",
    ("fe_contact/steppers/stacked.py", "_together", "1.0 ->"): "the unit of moduli that are divided again",
    (
        "fe_contact/budget/variation.py",
        "Variation._peak_time",
        "if curvature",
    ): "a guard against dividing by zero itself",
    ("fe_contact/budget/curve.py", "peak", "time[top + 2] - time"): "the unit of a polynomial's places",
    ("fe_contact/steppers/flat_end.py", "TOUCHING", ""): "what a flat end has instead of a contact problem",
    ("fe_contact/budget/curve.py", "DENSE", ""): "which of two sets of places, both dense, a curve is looked at",
    ("fe_contact/budget/curve.py", "EARLIEST", ""): "which of two sets of places, both dense, a curve is looked at",
    ("fe_contact/budget/variation.py", "Variation._about_peak", "1 -> 2"): "a dense place on: 2 % of a median bar",
    ("fe_contact/budget/variation.py", "Variation._duration", "if speed"): "a guard against dividing by zero itself",
    ("fe_contact/steppers/steps.py", "Inertia.moved", "strike.end_time - state.time"): "an end time but for rounding",
    ("fe_contact/relaxing_impact.py", "Marcher._instants", "self.strike.end_time *"): "an end time but for rounding",
    ("lumped/solvers/mdr/march.py", "Shrinking.__init__", "0.0 -> 0.1"): "a guard against dividing by zero itself",
    ("fe_contact/budget/certify.py", "ROUNDING", ""): "below what any result is asked for",
    ("fe_contact/indentation.py", "ROUNDING", ""): "below what any result is asked for",
    ("fe_contact/waves/targets/rod.py", "ROUNDING", "1e-09 -> 1e-08"): "below what any result is asked for",
    ("lumped/laws/_hereditary.py", "Course._rested", "1e-12 ->"): "an end time but for rounding",
    ("lumped/laws/correspondence.py", "ROUGH, FINE", ""): BEGINS,
    ("lumped/laws/correspondence.py", "MEMBER", "0.005 -> 0.05"): WORK,
    ("lumped/solvers/radau.py", "STAGES", ""): WORK,
    ("lumped/solvers/point/track.py", "NEWTONS", "8 -> 9"): WORK,
    ("lumped/solvers/point/bodies.py", "Dent.resistance", "1.0 ->"): "what is below zero, by which alone it is told",
    ("lumped/laws/correspondence.py", "FORGOTTEN", "1e-12 -> 1e-13"): "below what any result is asked for",
    ("lumped/laws/correspondence.py", "HereditaryDent._nothing", "0.0 ->"): "below what any result is asked for",
    ("fe_contact/plastic/ground.py", "_mesh", "0.0 -> 0.1"): "the far end's sides are longer than that",
    ("fe_contact/budget/certify.py", "_trusted_order", "1.0 ->"): "a factor of both changes that are compared",
    ("fe_contact/budget/variation.py", "_jitter", "1.0 ->"): "a factor that the distance of two histories is without",
    ("fe_contact/budget/variation.py", "_work", "a tenth"): "a factor of both works that are compared",
    ("fe_contact/budget/curve.py", "Curve.evened", "1 -> 2"): "the last row, beyond all that are told from it",
    ("fe_contact/budget/curve.py", "SHARES", "601 ->"): "how dense the places are at which a curve is looked at",
    ("fe_contact/budget/curve.py", "INSIDE", ""): "how many places are put into an interval",
    ("fe_contact/steppers/scaled_surface.py", "_missed", "EDGE * wide"): "a guard against dividing by zero itself",
    ("fe_contact/steppers/scaled_surface.py", "_missed", "BEYOND * stepper"): "a height where nothing ever touches",
    ("fe_contact/steppers/scaled_surface.py", "Stepper._problem", "BEYOND *"): "a height where nothing ever touches",
    ("fe_contact/steppers/steps.py", "Strike.total", ""): "a default that strikes of scenes do not use",
    ("fe_contact/waves/certify.py", "WaveRuns.__init__", "1 -> 0"): "fewer than any body has",
    ("fe_contact/waves/targets/rod.py", "moving", "0.0 -> 0.1"): "of a density that there is not: every rod has one",
    ("fe_contact/waves/targets/rod.py", "speed", "1.0 ->"): "of a density that there is not: every rod has one",
    ("fe_contact/steppers/steps.py", "March.memory_time", ""): "a default that marches with a memory do not use",
    ("fe_contact/budget/variation.py", "Softening.errors", "0.0 -> 0.1"): "of quantities that there are not",
    ("fe_contact/waves/certify.py", "DEGREE, REACH", ""): "another smoothing, about as wide",
    ("fe_contact/waves/impact.py", "LOCATED", ""): "a touch but for rounding",
    ("fe_contact/waves/moving.py", "WaveSide.mean", "1.0 ->"): "a guard against dividing by zero itself",
    (
        "fe_contact/large_strains.py",
        "KnownCurve.impact",
        "1.0 + uniform - tilted",
    ): "the other sign of an error, of which the size counts",
    ("fe_contact/waves/impact.py", "READ, STRAIGHT", "5 -> 4"): "ends are read to 0.019 of a step instead of 0.018",
    ("fe_contact/waves/impact.py", "READ, STRAIGHT", "3 -> 4"): "the same end, its bar 1.7 times as wide in the median",
    ("lumped/solvers/hereditary/march.py", "_landed", ""): "a break of the plan, or the same place but for rounding",
    ("fe_contact/waves/targets/layer.py", "ROUGH", ""): BEGINS,
    ("fe_contact/steppers/flat_end.py", "FlatEnd.of", "SHALLOW * radius"): "the depth of a linear press, divided again",
    ("fe_contact/steppers/flat_end.py", "FlatStepper.standing", ""): "the one place there is, from either end",
    ("fe_contact/steppers/flat_end.py", "FlatStepper.clearance", "a tenth"): "zero where the one place lands",
    ("lumped/solvers/mdr/nest.py", "Prescribed.propose", "1 -> 0"): "a guard for a march of one step",
    ("lumped/solvers/mdr/nest.py", "Prescribed.propose", "if len"): "a guard for a march of one step",
    ("fe_contact/budget/curve.py", "BEGUN", ""): "a guard against dividing by zero itself",
    ("fe_contact/budget/plan.py", "_settings", "1.0 ->"): BEGINS,
    ("fe_contact/budget/plan.py", "_settings", "0.5 ->"): "the place of what is told once the impact is known",
    ("fe_contact/steppers/struck.py", "FixedContact._by_secants", "0 ->"): WORK,
    ("fe_contact/steppers/struck.py", "FixedContact._by_secants", "iterations + solution.iterations"): WORK,
    ("fe_contact/indentation.py", "_overlapping", "SMALL * depth /"): GUESS,
    ("fe_contact/indentation.py", "_overlapping", "2.0 ->"): GUESS,
    ("fe_contact/indentation.py", "SMALL", ""): GUESS,
    ("fe_contact/indentation.py", "settings", "1.0 ->"): "the scales of an impact, which an indentation has not",
    ("fe_contact/indentation.py", "settings", "0.5 ->"): "the scales of an impact, which an indentation has not",
    ("fe_contact/indentation.py", "FEWEST_SOFT", "4 -> 5"): "a depth more tells what the penalty changes",
    ("fe_contact/indentation.py", "press", "growth * float(radii[i]) ->"): GUESS,
    ("fe_contact/indentation.py", "FEWEST", "12 -> 24"): "more depths tell what the mesh changes",
    ("fe_contact/indentation.py", "Indenting.finer", "found.budget[cause].max"): "one error for every depth",
    ("fe_contact/solids/pressing.py", "_pressed_evenly", "np.min(along) ->"): GUESS,
    ("fe_contact/solids/pressing.py", "_pressed_evenly", "0.5 ->"): GUESS,
    ("fe_contact/solids/pressing.py", "_pressed_evenly", "1.0 -> 10"): GUESS,
    ("fe_contact/solids/pressing.py", "_pressed_evenly", "0 -> -1"): "rounds of a confined block, which takes none",
    ("fe_contact/solids/newton.py", "BLUNT", ""): WORK,
    ("fe_contact/waves/moving.py", "BEYOND", "1000.0 -> 10000"): "a height where nothing ever touches",
    ("fe_contact/large_strains.py", "KnownCurve.errors", "2 -> 3"): "how many places a curve is looked at",
    (
        "fe_contact/large_strains.py",
        "KnownCurve.impact",
        "1.0 + uniform ->",
    ): "the other sign of an error, of which the size counts",
    ("fe_contact/solids/newton.py", "_hastened", "if promised > before -> False"): WORK,
    ("fe_contact/waves/plan.py", "FINER", "2.0 -> 20"): BEGINS,
    ("fe_contact/waves/plan.py", "STEPS", ""): BEGINS,
    ("fe_contact/large_strains.py", "SAMPLES", "160 -> 320"): WORK,
    (
        "fe_contact/waves/line_reading.py",
        "_undented",
        "1e-09 -> 1e-10",
    ): "a pair of roots that are real, or complex by far more",
    ("lumped/solvers/point/contact.py", "_corner", "1.0 ->"): "the unit of what is zero at a corner",
    ("fe_contact/budget/several.py", "Row._contact", "0.0 ->"): "of a peak that there is not: every contact has one",
    ("lumped/solvers/mdr/nest.py", "ALIGNING_TRIES, LEAST_SLOPE", "12 ->"): WORK,
    ("lumped/solvers/mdr/nest.py", "SHARPER, SURE", "4 ->"): "where a history ends, about, that no march follows on",
    ("lumped/solvers/mdr/nest.py", "SHARPER, SURE", "3 -> 4"): "where a history ends, about, that no march follows on",
    ("lumped/solvers/hereditary/approach.py", "_to_velocity", "3.0 ->"): GUESS,
    ("lumped/solvers/hereditary/approach.py", "_to_velocity", "3.0 * begin ->"): GUESS,
    ("lumped/solvers/hereditary/closing.py", "_Fallen.lasts", "0.0 ->"): GUESS,
    ("lumped/solvers/hereditary/rebound.py", "ReboundPieces._paces", "if self.before is not None -> False"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._released", "0.05 ->"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._released", "1.0 / 3.0"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._released", "if before is not here"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._released", "here.depth - before.depth ->"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._released", "here.radius * ("): GUESS,
    ("fe_contact/plastic/path.py", "Presser._stage", "last.pressure - first.pressure"): GUESS,
    ("fe_contact/plastic/path.py", "Presser._stage", "on * (last.pressure"): GUESS,
    ("fe_contact/plastic/settling.py", "Guesses._closed", "schur @ alone - stiff"): GUESS,
    ("fe_contact/plastic/settling.py", "Guesses._closed", "here + ENOUGH"): WORK,
    ("fe_contact/plastic/settling.py", "Guesses._shorter", "0.5 ->"): WORK,
    ("fe_contact/plastic/settling.py", "Guesses.closed_in", "1 -> 0"): GUESS,
    ("fe_contact/plastic/settling.py", "YieldingBody.settled", "0 -> -1"): GUESS,
    ("lumped/solvers/hereditary/rebound.py", "rebound", "0 -> "): WORK,
    ("lumped/result/history.py", "densified", "0 -> "): WORK,
    ("lumped/result/history.py", "densified", "1.0 -> 0.1"): WORK,
    ("fe_contact/indentation.py", "Indenting.certified", "2.0 -> "): WORK,
    ("fe_contact/plastic/course.py", "_spread", "1 -> 2"): WORK,
    ("fe_contact/plastic/course.py", "_spread", "1 -> 0"): "of depths that are one: no two are asked for as near",
    ("fe_contact/plastic/course.py", "_spread", "1e-09 ->"): "how far beside a step, in rounding",
    ("fe_contact/plastic/course.py", "ELEMENTS", ""): BEGINS,
    ("fe_contact/plastic/course.py", "RIM_ELEMENTS", ""): BEGINS,
    ("fe_contact/plastic/course.py", "LEAST_STEPS", ""): BEGINS,
    ("fe_contact/plastic/course.py", "MOST_ELEMENTS, MOST_STEPS", ""): BEGINS,
    ("fe_contact/plastic/course.py", "STEPS, RIM_STEPS", ""): BEGINS,
    ("fe_contact/plastic/course.py", "FOLLOWING, STEPS_FOLLOWING, RIM_FOLLOWING", ""): BEGINS,
    ("fe_contact/plastic/course.py", "FURTHER, FURTHEST", ""): BEGINS,
    (
        "lumped/solvers/mdr/march.py",
        "_found",
        "if tried.pull < left -> True",
    ): "past a turn of the edge, which the law tells that it does not follow",
    (
        "fe_contact/steppers/flat_end.py",
        "FlatStepper.clearance",
        "surface",
    ): "its one place is where the striker lands: no gap",
    ("fe_contact/steppers/flat_end.py", "FlatStepper.at_rest", "2 -> 1"): "nothing yet, which the first step spreads",
    ("fe_contact/contact/problem.py", "MAX_ITERATIONS", "60 -> 120"): WORK,
    (
        "fe_contact/contact/problem.py",
        "ENERGY_ROUNDING",
        "1e-15 -> 1e-14",
    ): "of the displacement 1e-7, as exact as asked",
    ("fe_contact/budget/plan.py", "plan", "2.0 -> "): BEGINS,
    ("fe_contact/budget/plan.py", "plan", "SPARE *"): BEGINS,
    ("lumped/solvers/point/memory.py", "recovering", "2.0 -> 20"): GUESS,
    ("fe_contact/waves/targets/half_space.py", "unit_of", "if scene.motion.impacts"): BEGINS,
    ("fe_contact/steppers/struck.py", "WIDTH", ""): BEGINS,
    ("fe_contact/waves/plan.py", "Cost.of", "0 -> "): WORK,
    ("lumped/solvers/point/contact.py", "FAINTEST", "1e-06 -> 1e-07"): WORK,
    ("fe_contact/schemes/galerkin.py", "SERIES", "5 -> 6"): "a term more, of 2e-15 where the series is asked",
    (
        "fe_contact/budget/variation.py",
        "Variation._peak_time",
        "1 ->",
    ): "a chord of some length, of a lone highest place",
    ("fe_contact/budget/curve.py", "FINE", "201 -> 402"): GUESS,
    ("fe_contact/bodies/modes.py", "IMAGINARY", ""): "any part whose square is rounding tells the same",
    ("fe_contact/bodies/modes.py", "INDEPENDENT", ""): "with 1e-11 of all energy or without, stiffness errs by 6e-9",
    ("lumped/solvers/mdr/nest.py", "Nest.level", "1.0 ->"): GUESS,
    (
        "lumped/solvers/hereditary/march.py",
        "_ahead",
        "SAME * (span[1] - span[0]) -> SAME",
    ): "a place that has landed on a break is that break itself",
}


@dataclass(frozen=True)
class Mutant:
    """One change of one file: the how-manyth, in which function or constant, on which line, and what."""

    file: str
    number: int
    scope: str
    line: int
    change: str

    @property
    def name(self) -> str:
        return f"{self.file}:{self.line} {self.scope}: {self.change}"

    @property
    def reason(self) -> str:
        """Why it does no harm, nothing where it may."""
        for (file, scope, begins), reason in HARMLESS.items():
            if scope == self.scope and fnmatch(self.file, file) and self.change.startswith(begins):
                return reason
        return ""

    @property
    def rows(self) -> range | None:
        """Lines of the statement that it changes, counted from where its function begins; None: all of the function."""
        first = self.function.line
        around = [lines for lines in statements(self.file) if self.line in lines]
        smallest = min(around, key=len, default=range(0))
        return range(smallest.start - first, smallest.stop - first) if first and smallest.start > first else None

    @property
    def function(self) -> Function:
        """That which it changes, none of a constant."""
        return functions(self.file).get(self.scope, Function())

    @cached_property
    def text(self) -> str:
        """The file with the change."""
        tree, number = ast.parse((ROOT / self.file).read_text(encoding="utf-8")), 0
        for parent, field, child, index, _ in places(tree):
            for kind in KINDS:
                for other, _ in kind(child):
                    if number == self.number:
                        _put(parent, field, index, other)
                        return ast.unparse(ast.fix_missing_locations(tree))
                    number += 1
        raise AssertionError(self.name)


# --- what is changed -------------------------------------------------------------------------------------------------

TURNED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
}  # fmt: skip
SWAPPED = {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "argmin": "argmax"}


def numbers(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """A number ten times larger, ten times smaller; an order one more, one less; a larger integer twice, half."""
    if not isinstance(node, ast.Constant) or isinstance(node.value, bool) or not isinstance(node.value, int | float):
        return
    if node.value and not FLOOR < abs(node.value) < 1.0 / FLOOR:
        return
    if isinstance(node.value, int):
        few = abs(node.value) <= FEW
        others: list[float] = [node.value + 1, node.value - 1] if few else [2 * node.value, node.value // 2]
    else:
        others = [10.0 * node.value, 0.1 * node.value] if node.value else [0.1]
    for other in others:
        yield ast.Constant(other), f"{node.value} -> {other:g}"


def comparisons(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """Turned round."""
    if isinstance(node, ast.Compare) and type(node.ops[0]) in TURNED:
        turned = copy.deepcopy(node)
        turned.ops[0] = TURNED[type(node.ops[0])]()
        yield turned, f"{ast.unparse(node)} -> {ast.unparse(turned)}"


def conditions(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """Held true, held false."""
    if isinstance(node, ast.If | ast.IfExp):
        for held in (True, False):
            other = copy.deepcopy(node)
            other.test = ast.Constant(held)
            yield other, f"if {ast.unparse(node.test)} -> {held}"


def joints(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """``and`` for ``or``, largest for smallest, and back."""
    if isinstance(node, ast.BoolOp):
        other: ast.AST = ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
        yield other, f"{ast.unparse(node)} -> {ast.unparse(other)}"
    if isinstance(node, ast.Call):
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        if name in SWAPPED:
            call = copy.deepcopy(node)
            if isinstance(call.func, ast.Attribute):
                call.func.attr = SWAPPED[name]
            elif isinstance(call.func, ast.Name):
                call.func.id = SWAPPED[name]
            yield call, f"{ast.unparse(node)} -> {ast.unparse(call)}"


def sums(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """A difference for a sum, and back; a factor or divisor left out."""
    if not isinstance(node, ast.BinOp):
        return
    others: list[ast.expr] = []
    if isinstance(node.op, ast.Add | ast.Sub):
        others = [ast.BinOp(node.left, ast.Sub() if isinstance(node.op, ast.Add) else ast.Add(), node.right)]
    elif isinstance(node.op, ast.Mult):
        others = [node.left, node.right]
    elif isinstance(node.op, ast.Div):
        others = [node.left]
    for other in others:
        yield other, f"{ast.unparse(node)} -> {ast.unparse(other)}"


def answers(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """A function that returns numbers returns a tenth of them, but of nothing."""
    if isinstance(node, ast.FunctionDef) and node.returns and ast.unparse(node.returns) in ("float", "Array"):
        last = node.body[-1]
        if (
            isinstance(last, ast.Return)
            and last.value is not None
            and ast.unparse(last.value) not in ("0.0", "math.nan")
        ):
            other = copy.deepcopy(node)
            other.body[-1] = ast.Return(ast.BinOp(ast.Constant(0.1), ast.Mult(), last.value))
            yield other, f"a tenth of {node.name}"


def told_bars(node: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """The bar of a quantity, or that of a force, a fifteenth where there is one."""
    if not isinstance(node, ast.Call):
        return
    other = copy.deepcopy(node)
    if getattr(node.func, "id", "") == "Quantity" and len(node.args) > 1:
        other.args[1] = _fifteenth(other.args[1])
        yield other, f"a fifteenth of {ast.unparse(node.args[1])}"
    for keyword in other.keywords:
        if keyword.arg == "force_error":
            text, keyword.value = ast.unparse(keyword.value), _fifteenth(keyword.value)
            yield other, f"a fifteenth of {text}"


def _fifteenth(bar: ast.expr) -> ast.expr:
    there = ast.Compare(bar, [ast.IsNot()], [ast.Constant(None)])
    return ast.IfExp(there, ast.BinOp(bar, ast.Div(), ast.Constant(15.0)), bar)


KINDS: tuple[Callable[[ast.AST], Iterator[tuple[ast.AST, str]]], ...] = (
    numbers, comparisons, conditions, joints, sums, answers, told_bars,
)  # fmt: skip


def places(node: ast.AST, scope: str = "", index_too: bool = False) -> Iterator[tuple[ast.AST, str, Any, Any, str]]:
    """Parent, field, child and index of all whose change could change an answer, and the scope it stands in."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases") or (name == "slice" and not index_too):
            continue
        if isinstance(node, ast.Dict) and name == "keys":
            continue
        for index, child in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(child, ast.Call) and _wordless(
                child
            ):  # what it is called of may change an answer all the same
                yield from places(child.func, scope, index_too)
            if not isinstance(child, ast.AST) or _wordless(child):
                continue
            inner = _scope(child, scope)
            yield node, name, child, index if isinstance(value, list) else None, inner
            yield from places(child, inner, index_too)


def _wordless(node: ast.AST) -> bool:
    """Raised failures, imports, texts, declarations and calls that only tell how far things are."""
    if isinstance(node, ast.Call):
        called = getattr(node.func, "attr", getattr(node.func, "id", ""))
        return any(word in called.lower() for word in SILENT)
    if isinstance(node, ast.If):
        return getattr(node.test, "id", "") == "TYPE_CHECKING"
    return isinstance(node, ast.Raise | ast.Assert | ast.Import | ast.ImportFrom | ast.JoinedStr)


def _scope(node: ast.AST, outer: str) -> str:
    """Dotted name of the function or class it is, or of a constant of a module or class.

    A function within another one belongs to that: a test that calls the outer one may call the inner one.
    """
    in_function = outer and not outer.rpartition(".")[2].lstrip("_")[:1].isupper()
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return outer if in_function else f"{outer}.{node.name}".lstrip(".")
    if isinstance(node, ast.Assign | ast.AnnAssign) and not in_function:
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        return f"{outer}.{ast.unparse(target).strip('()')}".lstrip(".") if not outer.isupper() else outer
    return outer


def all_of(file: str) -> list[Mutant]:
    """All of one file."""
    tree, found = ast.parse((ROOT / file).read_text(encoding="utf-8")), list[Mutant]()
    for _, _, child, _, scope in places(tree):
        for kind in KINDS:
            for _, change in kind(child):
                found.append(Mutant(file, len(found), scope, child.lineno, re.sub(r"\s+", " ", change)))
    return found


def _put(parent: ast.AST, field: str, index: int | None, child: ast.AST) -> None:
    if index is None:
        setattr(parent, field, child)
    else:
        getattr(parent, field)[index] = child


def drawn(files: list[str], seed: int, count: int, changes: str = "*") -> list[Mutant]:
    """So many mutants, every file alike, but those that errors and their bars come from four times as often."""
    rng = random.Random(seed)
    left = {file: [one for one in all_of(file) if fnmatch(one.change, changes)] for file in files}
    often, chosen = files + 3 * [file for file in files if any(fnmatch(file, one) for one in ERRORS)], list[Mutant]()
    while len(chosen) < count and any(left.values()):
        for file in rng.sample(often, len(often)):
            if left[file]:
                chosen.append(left[file].pop(rng.randrange(len(left[file]))))
    return chosen[:count]


# --- which tests call what: this file as a plugin of pytest ----------------------------------------------------------


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> Generator[None, Any, Any]:
    """Notes lines reached by a test that passes and its processor time; a file of tests is kept once it is through."""

    def stop(*_: object) -> None:
        pytest.fail("too slow")

    if item.path not in BEGUN:
        _forget()
    BEGUN.add(item.path)
    signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, LONGEST)
    began, failed = time.process_time(), item.session.testsfailed
    try:
        with _seen() as seen:
            return (yield)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        kept, taken = _kept(Path(os.environ["MUTANTS_CALLS"]), item.path), time.process_time() - began
        with kept.with_suffix(".part").open("a", encoding="utf-8") as file:
            if item.session.testsfailed == failed:
                file.write(json.dumps({"test": item.nodeid, "time": taken, "reached": _by_function(seen)}) + "\n")
        if nextitem is None or nextitem.path != item.path:
            kept.with_suffix(".part").rename(kept)


BEGUN = set[Path]()


def _forget() -> None:
    """Empties what the packages keep of earlier answers: a file of tests is to reach all that it needs by itself."""
    for one in gc.get_objects():
        if isinstance(one, _lru_cache_wrapper) and one.__module__.partition(".")[0] in PACKAGES:
            one.cache_clear()


@cache
def _kept(work: Path, tests: Path) -> Path:
    """Where the lines that a file of tests reaches are kept, as it is now."""
    return work / f"{tests.stem}-{hashlib.sha256(tests.read_bytes()).hexdigest()[:12]}.jsonl"


@contextmanager
def _seen() -> Iterator[set[tuple[CodeType, int]]]:
    """All lines of the packages reached meanwhile; from Python 3.12 on each tells so once, which is cheap."""
    seen = set[tuple[CodeType, int]]()
    if sys.version_info < (3, 12):
        left = dict[CodeType, set[int]]()  # lines not reached yet: without any a function is as fast as unwatched

        def traced(frame: FrameType, event: str, arg: object) -> Callable[..., Any] | None:
            seen.add((frame.f_code, frame.f_lineno))
            left[frame.f_code].discard(frame.f_lineno)
            return traced

        def entered(frame: FrameType, event: str, arg: object) -> Callable[..., Any] | None:
            code = frame.f_code
            if code not in left:
                left[code] = {line for _, _, line in code.co_lines() if line} if _ours(code) else set()
            return traced if left[code] else None

        sys.settrace(entered)
        yield seen
        sys.settrace(None)
        return
    tool, events = sys.monitoring.COVERAGE_ID, sys.monitoring.events

    def begun(code: CodeType, offset: int) -> object:
        if _ours(code):
            sys.monitoring.set_local_events(tool, code, events.LINE)
        return sys.monitoring.DISABLE

    def reached(code: CodeType, line: int) -> object:
        seen.add((code, line))
        return sys.monitoring.DISABLE

    sys.monitoring.use_tool_id(tool, "mutants")
    sys.monitoring.register_callback(tool, events.PY_START, begun)
    sys.monitoring.register_callback(tool, events.LINE, reached)
    sys.monitoring.restart_events()
    sys.monitoring.set_events(tool, events.PY_START)
    yield seen
    sys.monitoring.set_events(tool, events.NO_EVENTS)
    sys.monitoring.free_tool_id(tool)


@cache
def _ours(code: CodeType) -> bool:
    path = Path(code.co_filename)
    return path.is_relative_to(ROOT) and path.relative_to(ROOT).parts[0] in PACKAGES


def _by_function(seen: set[tuple[CodeType, int]]) -> dict[str, list[int]]:
    """Lines counted from where their function begins, by its file, name and source."""
    found = defaultdict[str, list[int]](list)
    for code, line in seen:
        file, scope = str(Path(code.co_filename).relative_to(ROOT)), code.co_qualname.partition(".<locals>")[0]
        if function := functions(file).get(scope):
            found[f"{file}:{scope}:{function.digest}"].append(line - function.line)
    return found


class Function(NamedTuple):
    """Where it begins, what tells its source from another, and whether it keeps answers, so that few tests call it."""

    line: int = 0
    digest: str = ""
    keeps: bool = False


@cache
def functions(file: str) -> dict[str, Function]:
    """Those of a source by their names, but for those within another one."""
    tree, found = ast.parse((ROOT / file).read_text(encoding="utf-8")), dict[str, Function]()
    for _, _, child, _, scope in places(tree):
        if isinstance(child, ast.FunctionDef) and scope.rpartition(".")[2] == child.name:
            digest = hashlib.sha256(ast.unparse(child).encode()).hexdigest()[:6]
            keeps = any(re.match(r"cache$|lru_cache", ast.unparse(one)) for one in child.decorator_list)
            found[scope] = Function(child.lineno, digest, keeps)
    return found


@cache
def statements(file: str) -> list[range]:
    """Lines of every statement of a source, without the body that it may have."""
    found = list[range]()
    for node in ast.walk(ast.parse((ROOT / file).read_text(encoding="utf-8"))):
        if isinstance(node, ast.stmt) and not isinstance(node, ast.FunctionDef | ast.ClassDef):
            inner = [child.lineno for child in ast.iter_child_nodes(node) if isinstance(child, ast.stmt)]
            found.append(range(node.lineno, min(inner) if inner else (node.end_lineno or node.lineno) + 1))
    return found


@dataclass(frozen=True)
class Asked:
    """A test that passes, its processor time, s, and the lines that it reaches, by function, from where that begins."""

    test: str
    time: float
    reached: dict[str, list[int]]

    @cached_property
    def functions(self) -> frozenset[str]:
        """Those that it calls, whatever their source was."""
        return frozenset(key.rpartition(":")[0] for key in self.reached)

    def reaches(self, mutant: Mutant) -> bool:
        """Whether it runs the mutated lines, or calls their function where that was another one when it was asked."""
        scope = f"{mutant.file}:{mutant.scope}"
        lines = self.reached.get(f"{scope}:{mutant.function.digest}")
        if lines is None:
            return scope in self.functions
        return mutant.rows is None or any(line in mutant.rows for line in lines)


def calls(work: Path, patterns: Iterable[str], roots: list[Path]) -> list[Asked]:
    """Every test that passes in a copy, its time and what it reaches; of a test file asked before it is kept."""
    files = [path for pattern in patterns for path in sorted(ROOT.glob(pattern))]
    unknown = [path for path in files if not _kept(work, path).exists()]
    for part in work.glob("*.part"):
        part.unlink()

    def ask(some: list[Path], root: Path) -> None:
        environment = _environment(root) | {"MUTANTS_CALLS": str(work)}
        environment["PYTHONPATH"] += f"{os.pathsep}{root / 'tests'}"
        # what needs a package that is not here cannot be asked
        command = [sys.executable, "-m", "pytest", *PYTEST, "--continue-on-collection-errors", "-p", "mutants"]
        command += [str(path.relative_to(ROOT)) for path in some]
        asked = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=False)
        if asked.returncode not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
            raise SystemExit(asked.stdout)
        for path in some:
            _kept(work, path).touch()  # none of its tests may be a plain one

    shares = [(some, root) for k, root in enumerate(roots) if (some := unknown[k :: len(roots)])]
    with ThreadPoolExecutor(len(roots)) as pool:
        list(pool.map(ask, *zip(*shares, strict=True))) if shares else []
    kept = (_kept(work, path).read_text(encoding="utf-8").splitlines() for path in files)
    return [Asked(**json.loads(line)) for lines in kept for line in lines]


def users(scope: str, file: str) -> set[str]:
    """Functions that change with a scope: itself, or those that name a constant, by way of other constants too."""
    found, left, done = {f"{file}:{scope}"}, [(file, scope)], set[tuple[str, str]]()
    while left:
        home, constant = left.pop()
        done.add((home, constant))
        for other in sources():
            for name in re.findall(r"\w+", constant.rpartition(".")[2]):
                for at in _named(other, home)[name]:
                    found.add(f"{other}:{at}")
                    if at not in functions(other) and (other, at) not in done:
                        left.append((other, at))
    return found


@cache
def _named(file: str, home: str) -> dict[str, set[str]]:
    """Which scopes of a source name what of another one: by name where it is imported from there, else by its owner."""
    tree, uses = ast.parse((ROOT / file).read_text(encoding="utf-8")), defaultdict[str, set[str]](set)
    module = home.removesuffix(".py").replace("/", ".").removesuffix(".__init__")
    froms = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module == module]
    imported = {alias.name for node in froms for alias in node.names}
    for _, _, child, _, scope in places(tree, index_too=True):
        if isinstance(child, ast.Name) and (file == home or child.id in imported):
            uses[child.id].add(scope)
        elif isinstance(child, ast.Attribute):
            uses[child.attr].add(scope)
    return uses


@cache
def words(file: str) -> frozenset[str]:
    """All of a test file: a constant may be read there."""
    return frozenset(re.findall(r"\w+", (ROOT / file).read_text(encoding="utf-8")))


@cache
def sources() -> list[str]:
    """Every file of the packages."""
    return [str(path.relative_to(ROOT)) for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]


# --- what a mutant meets ---------------------------------------------------------------------------------------------

PYTEST = ("-q", "-n0", "-p", "no:cacheprovider", "--no-header")
FORKED = multiprocessing.get_context("forkserver")  # no mutant waits for libraries to be imported
LIBRARIES = ("__main__", "pytest", "numpy", "scipy.optimize", "scipy.integrate", "skfem", "meshio", "gmsh")
FIRST = 2.0  # s of the tests that are asked first: most mutants do not live longer
KILLED, IMPORT = "killed by ", "killed at import"


def _environment(root: Path) -> dict[str, str]:
    return {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(root)}


def met(mutant: Mutant, tests: list[Asked], killers: set[str], budget: float, copied: Path) -> str:
    """What becomes of it: the test that fails, "timeout", "survived", or "no test reaches it"."""
    chosen = asked_of(mutant, tests, killers, budget)
    if not chosen:
        return "no test reaches it"
    first = sum(spent <= FIRST for spent in accumulate(test.time for test in chosen))
    target, pristine = copied / mutant.file, ROOT / mutant.file
    target.write_text(mutant.text, encoding="utf-8")
    try:
        for some in (chosen[:first], chosen[first:]):
            found = _fate(some, copied) if some else ""
            if found:
                return found
    finally:
        shutil.copy2(pristine, target)  # with its time: else Python would go on with what it compiled
    return f"survived {len(chosen)} tests"


def asked_of(mutant: Mutant, tests: list[Asked], killers: set[str], budget: float) -> list[Asked]:
    """Tests that reach what it changes, up to so many seconds: first those that killed others of its file, then fast.

    Of a constant those that call what names it, or that name it themselves. So of a function whose answers are kept,
    which only the first test that needs it calls.
    """
    name = mutant.scope.rpartition(".")[2]
    near = [test for test in tests if test.reaches(mutant)]
    if mutant.function.keeps or not mutant.function.line:
        changed = users(mutant.scope, mutant.file)
        near = [test for test in tests if changed & test.functions or name in words(test.test.partition("::")[0])]
    ordered = sorted(near, key=lambda test: (test.test not in killers, test.time))
    spent = accumulate(test.time for test in ordered)
    return [test for test, until in zip(ordered, spent, strict=True) if until <= budget]


def _fate(tests: list[Asked], copied: Path) -> str:
    """What tests say of the code in a folder, nothing if they pass."""
    most = int(3.0 * sum(test.time for test in tests) + 20.0)  # s of processor time; one that hangs is noticed
    said, names = copied / "said", [test.test for test in tests]
    for asked in (names, list(dict.fromkeys(name.partition("[")[0] for name in names))):
        one = FORKED.Process(target=_run, args=(asked, copied, said, most))
        one.start()
        one.join()
        if one.exitcode != pytest.ExitCode.USAGE_ERROR:  # else a case of a test has another name by the code's answer
            break
    else:
        if "while loading conftest" in said.read_text(encoding="utf-8"):
            return IMPORT
        return "not asked, a test has another name now; cure: another --work"
    if one.exitcode == 0:
        return ""
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", said.read_text(encoding="utf-8"), re.MULTILINE)
    return f"{KILLED}{failed[1]}" if failed else f"{KILLED}timeout" if (one.exitcode or 0) < 0 else IMPORT


def _run(tests: list[str], root: Path, said: Path, most: int) -> None:
    """Tests of the code in a folder, in a process of its own."""
    resource.setrlimit(resource.RLIMIT_CPU, (most, most))
    os.chdir(root)
    os.environ.update(_environment(root))
    sys.path.insert(0, str(root))
    with said.open("w", encoding="utf-8") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    code = pytest.main([*PYTEST, "-x", *tests])
    sys.stdout.flush()
    os._exit(code)


def answered(
    mutants: list[Mutant], tests: list[Asked], budget: float, work: Path, roots: list[Path]
) -> dict[Mutant, str]:
    """What every mutant meets; answers at hand are kept but those of survivors, whom new tests may kill."""
    kept = work / "answers.json"
    known: dict[str, str] = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    free: SimpleQueue[Path] = SimpleQueue()
    for root in roots:
        free.put(root)

    def one(mutant: Mutant) -> tuple[Mutant, str]:
        key = f"{mutant.name} {hashlib.sha256(mutant.text.encode()).hexdigest()[:12]}"
        if "killed" not in known.get(key, ""):
            root = free.get()
            by = {answer for name, answer in known.items() if name.startswith(f"{mutant.file}:")}
            try:
                known[key] = met(mutant, tests, {answer.removeprefix(KILLED) for answer in by}, budget, root)
            finally:
                free.put(root)
            kept.write_text(json.dumps(known, indent=1), encoding="utf-8")
            sys.stdout.write(f"{mutant.name}\n    {known[key]}\n")
            sys.stdout.flush()
        return mutant, known[key]

    with ThreadPoolExecutor(len(roots)) as pool:
        found = dict(pool.map(one, mutants))
    killers = {answer.removeprefix(KILLED) for answer in found.values()}
    alone = _fate([test for test in tests if test.test in killers], roots[0])
    if alone:
        raise SystemExit(f"without a mutant: {alone}\n{(roots[0] / 'said').read_text(encoding='utf-8')}")
    return found


@contextmanager
def copies(count: int) -> Iterator[list[Path]]:
    """So many copies of what tests need of the checkout."""
    roots = [Path(tempfile.mkdtemp(prefix="mutant-")) for _ in range(count)]
    try:
        for root in roots:
            for part in (*PACKAGES, "tests", "data", "pyproject.toml"):
                _copy(ROOT / part, root / part)
        yield roots
    finally:
        for root in roots:
            shutil.rmtree(root)


def _copy(source: Path, target: Path) -> None:
    if source.is_dir():
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
    else:
        shutil.copyfile(source, target)


def told(answers: dict[Mutant, str]) -> Iterable[str]:
    """The share killed, by file, of all and of those that could do harm, and who survived."""
    files: dict[str, list[bool]] = defaultdict(list)
    for mutant, answer in answers.items():
        files[mutant.file].append("killed" in answer)
    yield from (f"{sum(killed):4d} of {len(killed):3d}  {file}" for file, killed in sorted(files.items()))
    left = [one for one, answer in answers.items() if "killed" not in answer]
    yield from (f"{answers[one]}: {one.name}" for one in left if not one.reason)
    yield from (f"no harm: {one.name}: {one.reason}" for one in left if one.reason)
    killed, harmless = len(answers) - len(left), sum(bool(one.reason) for one in left)
    for drawn_of, others in ((len(answers), "all"), (len(answers) - harmless, "those that could do harm")):
        yield f"{killed} of {drawn_of} killed, {others}: {killed / max(drawn_of, 1):.0%}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--budget", type=float, default=20.0, help="s of processor time for one mutant")
    parser.add_argument("--only", nargs="+", default=["*"], help="patterns of files to mutate")
    parser.add_argument("--changes", default="*", help='pattern of what is changed: "a fifteenth*"')
    parser.add_argument("--tests", nargs="+", default=TESTS, help="patterns of files that are asked")
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "fe-contact-mutants")
    given = parser.parse_args()
    given.work.mkdir(exist_ok=True)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    FORKED.set_forkserver_preload(list(LIBRARIES))
    files = [file for file in sources() if any(fnmatch(file, pattern) for pattern in CORE)]
    files = [file for file in files if any(fnmatch(file, pattern) for pattern in given.only)]
    chosen = drawn(files, given.seed, given.count, given.changes)
    with copies(given.jobs) as roots:
        tests = calls(given.work, given.tests, roots)
        answers = answered(chosen, tests, given.budget, given.work, roots)
    sys.stdout.write("\n".join(told(answers)) + "\n")


if __name__ == "__main__":
    main()
