"""Exponents of contact on layers, and what is read from impacts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from fe_contact.studies.exponents.impacts import sentences
from fe_contact.studies.exponents.impacts import to_dict as of_impacts
from fe_contact.studies.exponents.layers import Check, named
from fe_contact.studies.exponents.study import Exponents, study
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns

ROUNDING = 1e-9  # rounding: of an exponent, and of D over the row's
FIGURES = (
    base.Figure("exponents", "Local exponent and D from the half-space to the thin layer, exact and by finite elements",
           ("exponents.csv", "finite_spheres.csv")),
    base.Figure("exponents_from_impacts", "Exponents read from impacts on viscoelastic bodies, and how wrong they are",
           ("exponents_from_impacts.csv",)),
)  # fmt: skip
LISTING = base.Listing(
    "exponents.csv",
    "By finite elements",
    (
        *columns("shape", "profile_exponent", "base"),
        Column("nu", "ν"),
        Column("a_over_h", "a/h"),
        Column("exponent", "exponent", "exponent_error"),
        Column("row_exponent", "of the half-space"),
        Column("thin_exponent", "of the thin layer"),
        Column("D_over_row", "D over the row's", "D_over_row_error"),
    ),
    only=("method", "fe"),
)


def make(asked: base.Request) -> base.Made:
    """Layers, finite spheres and impacts."""
    found = study(asked.quick, asked.where, asked.progress, asked.jobs)
    from fe_contact.studies.exponents.chart import plot_exponents

    said = (*(one.told for one in found.pairs), *sentences(found.impacts))
    section = base.Section((headline(found),), said, FIGURES, (LISTING,), worst(found.checks), missed=found.missed)
    return base.Made(section, (found.write, partial(plot_exponents, found)))


def headline(found: Exponents) -> base.Headline:
    """Whether finite elements find the exact exponents; how wrong those are that are read from impacts."""
    covered, biases = [one.covered for one in found.checks], of_impacts(found.impacts)["worst_bias"]
    reader = max(biases, key=lambda name: abs(biases[name]))
    said = (
        f"Exponents and D on layers: finite elements meet the exact answer at {covered.count(True)} of {len(covered)} "
        f"places; read from viscoelastic impacts, an exponent is off by up to {biases[reader]:+.2f} "
        f"({reader.replace('_', ' ')})."
    )
    return base.Headline(base.VERIFIED if all(covered) else base.DIFFERS, said)


def worst(checks: Sequence[Check]) -> base.Worst:
    """Of exponents and of D, by finite elements against the exact ones."""
    ratios = [ratio for one in checks for ratio in _ratios(one)]
    ratio, place = max(ratios)
    return base.Worst(ratio, len(ratios), place)


def _ratios(one: Check) -> Iterator[tuple[float, str]]:
    place = f"{one.profile.label}, {named(one.base, one.nu)}, a/h = {one.ratio:g}"
    for name, found, exact in (
        ("exponent", one.exponent, one.exact_exponent),
        ("D", one.factor, one.exact_factor),
    ):
        yield abs((found.value or 0.0) - exact) / ((found.error or 0.0) + ROUNDING), f"{name} of the {place}"


MEMBER = base.ReportPart(
    rank=30,
    title="Exponents",
    question="Where does the exponent of force over depth lie, and what do impacts tell of it?",
    command="fe-contact exponents",
    make=make,
    seconds=86,
    quick="places and Poisson's ratios, and most impacts",
)
