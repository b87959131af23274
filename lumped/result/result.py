"""A result: history, quantities with error bars, and the two ledgers."""

from __future__ import annotations

import html
import math
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from typing import ClassVar

from lumped.numbers import Array
from lumped.result.folder import RECORD, publish
from lumped.result.history import History
from lumped.scene.geometry import Geometry, relaxed_impact
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema import Table
from lumped.schema.csv_file import write_columns
from lumped.schema.json_file import plain, write_json
from lumped.schema.shown import Picture, html_table

COLUMNS_LEFT = ("time_after_separation_s", "depth_m", "depth_error_m")
SCHEMA = "fe-contact/result/1"
UNITS = {
    "peak_force": "N",
    "peak_time": "s",
    "peak_depth": "m",
    "duration": "s",
    "restitution": "1",
    "impulse": "N s",
    "history_l2": "1",
}
# `tolerance` rules these relatively; restitution and history_l2 absolutely; peak_time not at all.
RULED_RELATIVE = ("peak_force", "peak_depth", "duration", "impulse")
RULED_ABSOLUTE = ("restitution", "history_l2")
# Every account has these; one whose bodies yield has its `plastic` work too.
ENERGY_TERMS = ("in", "out", "stored", "viscous", "radiated", "contact", "numerical", "residual")
WITHIN, ABOVE, OPEN, UNKNOWN = "within tolerance", "above it", "open", "unknown"
NO_KEY = "no larger model here"
PEAK_FORCE = "peak force"
LEFT_OUT = ("neglected", "none assumed")  # how a ledger's effect is treated that is not there at all


@dataclass(frozen=True, eq=False)
class IndentationLeft:
    """Rows (n,): time after separation, s, depth and its bar, m; the first row at separation.

    ``permanent``, m: what is left for ever; ``retardation_times`` (k,), s: those of the creep compliance, with which
    the rest goes.
    """

    time: Array
    depth: Array
    error: Array
    permanent: float
    retardation_times: tuple[float, ...]

    def to_json(self) -> Table:
        """What result.json says of it."""
        return {
            "residual_depth": {"value": float(self.depth[0]), "error": float(self.error[0]), "unit": "m"},
            "permanent_depth": self.permanent,
            "retardation_times": self.retardation_times,
            "time": self.time,
            "depth": self.depth,
            "error": self.error,
        }

    def write_csv(self, path: Path) -> None:
        """Write the rows, every value with all its digits."""
        write_columns(path, COLUMNS_LEFT, [self.time, self.depth, self.error])


@dataclass(frozen=True)
class Quantity:
    """`value` and half-width `error`, both of its `unit`: |value - exact| <= error. None where undefined."""

    value: float | None
    error: float | None
    unit: str

    def __str__(self) -> str:
        """Value, bar and unit; without a unit none, and a value that is always zero is its bar alone."""
        if self.value is None:
            return "undefined: no separation"
        value = f"{self.value:.6g} " if self.value or self.unit != "1" else ""
        return f"{value}+- {self.error or 0.0:.1e} {'' if self.unit == '1' else self.unit}".rstrip()


def percent(share: float) -> str:
    """A share of the peak force in words."""
    return f"{100.0 * share:.2g} %" if abs(share) < 1.0 else f"{100.0 * share:.0f} %"


@dataclass(frozen=True)
class LedgerEntry:
    """One thing the model leaves out, and its estimated effect relative to the peak force, None where unknown.

    `key` with `value` selects the larger model, empty where there is none. `spread`: lowest and highest change of the
    force where the scene does not decide; the estimate is then what is left out at least, None where that may be
    nothing.
    """

    effect: str
    treated: str
    estimate: float | None
    note: str = ""
    key: str = ""
    spread: tuple[float, float] | None = None
    value: bool | float | str | None = None

    @property
    def size(self) -> float:
        """The most that is left out, as far as it is known."""
        return max(map(abs, self.spread)) if self.spread else self.estimate or 0.0

    @property
    def known(self) -> bool:
        """Whether anything is said of its size."""
        return self.estimate is not None or self.spread is not None

    def exceeds(self, tolerance: float) -> bool:
        """Whether it is certainly above what may be left out."""
        return self.estimate is not None and self.estimate > tolerance

    def verdict(self, tolerance: float) -> str:
        """Whether the effect may be left out: within tolerance, above it, open by the scene, or unknown."""
        if not self.known:
            return f"{UNKNOWN}: {self.note}"
        if self.size <= tolerance:
            return WITHIN
        return f"{ABOVE}: {self.key or NO_KEY}" if self.exceeds(tolerance) else f"{OPEN}: {self.note}"

    @property
    def setting(self) -> str:
        """The key with its value, as --set takes it."""
        return f"{self.key}={str(self.value).lower() if isinstance(self.value, bool) else self.value}"

    @property
    def cure(self) -> str:
        """How a run includes it, in words; that nothing does where there is no larger model."""
        if not self.key:
            return NO_KEY
        return f"to include it: --set {self.setting}"

    def told_of(self, force: str) -> str:
        """What is left out, by how much that changes a force called so, and how to include it."""
        left = "is left out" if self.treated in LEFT_OUT else f"is taken as {self.treated}"
        size = f"it may change the {force} by {percent(self.size)}" if self.known else "by how much is unknown"
        return f"{self.effect} {left}; {size}; {self.cure}"

    def line(self, tolerance: float) -> str:
        """Effect, treatment, size and verdict, as a plan lists them."""
        spread = "" if self.spread is None else " to ".join(map(percent, self.spread))
        size = spread or (percent(self.estimate) if self.estimate else "")
        said = f"above the tolerance; {self.cure}" if self.exceeds(tolerance) else self.verdict(tolerance)
        return f"{self.effect} ({self.treated}): {', '.join(filter(None, (size, said)))}"

    def to_json(self, tolerance: float) -> Table:
        """Its fields, and its verdict at a tolerance."""
        return asdict(self) | {"verdict": self.verdict(tolerance)}


@dataclass(frozen=True, eq=False)
class Result:
    """What one method says of one scene.

    `error_budget`: relative to peak force, by cause; `error_budget_by_quantity`: the same for every quantity.
    `model` is the model as resolved, to which every claimed error refers. Energies, and their bars where they are told,
    in J. `contacts`: start, duration, velocity, restitution, peak_force, peak_time, peak_depth of each, where several
    were asked for; duration and restitution among the quantities are the first one's. `recovery`: of the surface after
    separation, None where it is not told. `weighed`: every method with its bar, cost, s, and why it was taken or not,
    where the cheapest was asked for.
    """

    method: str
    converged: bool
    separated: bool
    scene: Scene
    model: Model
    tolerance: float
    history: History
    quantities: Mapping[str, Quantity]
    numerics: Table = field(default_factory=dict)
    error_budget: Mapping[str, float] = field(default_factory=dict)
    error_budget_by_quantity: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    model_ledger: Sequence[LedgerEntry] = ()
    energy: Mapping[str, float | None] = field(default_factory=dict)
    energy_error: Mapping[str, float] = field(default_factory=dict)
    provenance: Mapping[str, object] = field(default_factory=dict)
    timing: Mapping[str, object] = field(default_factory=dict)
    work: Mapping[str, float] = field(default_factory=dict)
    message: str = ""
    contacts: tuple[Mapping[str, float | None], ...] = ()
    recovery: IndentationLeft | None = None
    weighed: tuple[Table, ...] = ()
    ruled_force: ClassVar[str] = PEAK_FORCE  # to which the ledger's estimates are relative

    @property
    def model_sufficient(self) -> bool:
        """Whether no effect that can be judged exceeds the tolerance."""
        return sufficient(self.model_ledger, self.tolerance)

    def __repr__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        head = f"<b>{html.escape(self.scene.name)}</b>: {self.method}, tolerance {self.tolerance:g}"
        table = html_table(("quantity", "value"), self.quantities.items())
        return f"<p>{head}</p>{table}{self.plot().svg}<p>{html.escape(good_to(self.model_ledger))}</p>"

    def plot(self, **others: Result) -> Picture:
        """Its force, N, over time, s, beside those of other results by their names."""
        return self.history.plot(**{name: one.history for name, one in others.items()})

    def summary(self) -> str:
        """Quantities with their bars, a line each, every one of several contacts, and what the model is good to."""
        known = {name: value for name, value in self.quantities.items() if value.value is not None or self.converged}
        lines = [f"{self.scene.name}: {self.method}, tolerance {self.tolerance:g}"]
        lines += [f"{name:13s} {quantity}" for name, quantity in known.items()]
        lines += [_contact(number, contact) for number, contact in enumerate(self.contacts, start=1)]
        lines += [self.message] if self.message and (self.contacts or not self.converged) else []
        return "\n  ".join([*lines, *filter(None, [good_to(self.model_ledger)])])

    def to_json(self) -> Table:
        """The content of result.json; what is not finite is null."""
        values = {name: quantity.value for name, quantity in self.quantities.items()}
        content = {
            "schema": SCHEMA,
            "method": self.method,
            "weighed": self.weighed,
            "converged": self.converged,
            "separated": self.separated,
            "model_sufficient": self.model_sufficient,
            "tolerance": self.tolerance,
            "message": self.message,
            "scene": self.scene.to_dict(),
            "model": self.model.resolved(self.scene.material),
            "numerics": self.numerics,
            "quantities": {name: asdict(quantity) for name, quantity in self.quantities.items()},
            "dimensionless": groups(self.scene, values, self.history),
            "contacts": list(self.contacts),
            "recovery": None if self.recovery is None else self.recovery.to_json(),
            "error_budget": self.error_budget,
            "error_budget_by_quantity": self.error_budget_by_quantity,
            "model_ledger": [entry.to_json(self.tolerance) for entry in self.model_ledger],
            "energy": {**dict.fromkeys(ENERGY_TERMS), **self.energy},
            "energy_error": self.energy_error,
            "work": self.work,
            "provenance": self.provenance,
            "timing": self.timing,
        }
        return dict(plain(content))

    def write(self, directory: str | Path) -> None:
        """Make history.csv, result.json and, where it is told, recovery.csv the content of a folder of results.

        Raises CannotWrite; what was there stays then, see :mod:`lumped.result.folder`.
        """
        publish(Path(directory), self.write_files)

    def write_files(self, folder: Path) -> None:
        """The same files, one after the other, into a folder that is there."""
        self.history.write_csv(folder / "history.csv")
        if self.recovery is not None:
            self.recovery.write_csv(folder / "recovery.csv")
        write_json(folder / RECORD, self.to_json())


def _contact(number: int, contact: Mapping[str, float | None]) -> str:
    """One of several contacts in a line."""
    names = {"duration": "s", "restitution": "", "peak_force": "N"}
    told = [f"{name} {contact[name]:.6g} {unit}".rstrip() for name, unit in names.items() if contact[name] is not None]
    return f"contact {number} at {contact['start']:.6g} s: {', '.join(told)}"


def write_failure(directory: Path, scene: Scene, method: str, message: str) -> None:
    """Write the result.json of an impact that no solve brought to an end: what is known, and null for the rest.

    It takes the place of an older result. Raises CannotWrite.
    """
    content = {
        "schema": SCHEMA,
        "method": method,
        "converged": False,
        "separated": False,
        "model_sufficient": None,
        "message": message,
        "scene": scene.to_dict(),
        "model": scene.model.resolved(scene.material),
        "quantities": {name: {"value": None, "error": None, "unit": unit} for name, unit in UNITS.items()},
        "provenance": provenance(),
    }
    publish(directory, lambda folder: write_json(folder / RECORD, plain(content)))


def meets(quantities: Mapping[str, Quantity], tolerance: float) -> bool:
    """Whether every error bar that the tolerance rules lies within it."""
    return not unmet(quantities, tolerance)


def unmet(quantities: Mapping[str, Quantity], tolerance: float) -> str:
    """Which error bars exceed the tolerance, in words; empty when none does."""
    found = []
    for name in (*RULED_RELATIVE, *RULED_ABSOLUTE):
        quantity = quantities[name]
        scale = abs(quantity.value or 0.0) if name in RULED_RELATIVE else 1.0
        if quantity.error is not None and not quantity.error <= tolerance * scale:  # a bar that is no number is none
            reached = f"{quantity.error / scale:.2g}" if scale else f"{quantity.error:.2g} {quantity.unit}"
            found.append(f"{name} to {reached}")
    return f"tolerance {tolerance:g} not reached: {', '.join(found)}" if found else ""


def largest_bar(quantities: Mapping[str, Quantity]) -> float:
    """The largest bar that a tolerance rules, in terms of it; infinite where one is unknown."""
    bars = [0.0]
    for name in (*RULED_RELATIVE, *RULED_ABSOLUTE):
        value, error = quantities[name].value, quantities[name].error
        if value is not None and error is not None:
            bars.append(error / (abs(value) or math.inf) if name in RULED_RELATIVE else error)
    return max(math.inf if math.isnan(bar) else bar for bar in bars)


def sufficient(ledger: Sequence[LedgerEntry], tolerance: float) -> bool:
    """Whether no effect certainly exceeds what may be left out."""
    return not any(entry.exceeds(tolerance) for entry in ledger)


def worst(ledger: Sequence[LedgerEntry]) -> LedgerEntry:
    """The entry of the largest estimate, of a ledger in which one is known."""
    return max((entry for entry in ledger if entry.estimate is not None), key=lambda entry: entry.estimate or 0.0)


def good_to(ledger: Sequence[LedgerEntry], force: str = PEAK_FORCE) -> str:
    """A line: how much of a force called so a model may miss, by what, what is not known; empty where nothing is."""
    if not any(entry.known for entry in ledger):
        return ""
    most = max(ledger, key=lambda entry: entry.size)
    unknown = [entry.effect for entry in ledger if not entry.known]
    said = f"this model is good to about {percent(most.size)} of the {force}, for {most.effect}" if most.size else ""
    return "; ".join(filter(None, (said, f"unknown: {', '.join(unknown)}" if unknown else "")))


def groups(scene: Scene, values: Mapping[str, float | None], history: History) -> Table:
    """What an impact depends on without units, and its peak and times in units of an elastic impact of the profile.

    Two impacts with the same profile, base and groups have the same history in these units. They come by name, of the
    ``values`` of the quantities; empty without a geometry, None where one is undefined.

    E_i/E_inf of the contact moduli; tau/T, every relaxation time over the duration; nu; a/R with the largest contact
    radius; h/a, thickness over that; and, F0 and T0 the peak force and duration of the shape's elastic impact on the
    half-space with the relaxed modulus (a fluid's with the instantaneous one, or that of a dashpot alone), F/F0, t/T0
    at the peak, T/T0.
    """
    if not scene.has_geometry:
        return {}
    geometry, modulus = scene.geometry, scene.contact_modulus
    largest = float(history.contact_radius.max())
    duration = values["duration"]
    unit = relaxed_impact(geometry.shape, modulus, scene.reduced_mass, scene.velocity)
    return {
        "E_i/E_inf": _over(modulus.instantaneous, modulus.relaxed),
        "tau/T": [_over(tau, duration) for tau in modulus.times],
        "nu": geometry.material.nu,
        "a/R": _over(largest, geometry.shape.tip_radius),
        "h/a": _over(geometry.target.body_depth, largest),
        "F/F0": _over(values["peak_force"], unit.force),
        "t/T0": _over(values["peak_time"], unit.duration),
        "T/T0": _over(duration, unit.duration),
        "F0": unit.force,
        "T0": unit.duration,
    }


def groups_at_rest(geometry: Geometry, contact_radius: Array) -> Table:
    """Those of a slow indentation, which knows no time: E_i/E_inf, nu, a/R and h/a with the largest of its radii, m."""
    modulus, largest = geometry.contact_modulus, float(contact_radius.max())
    return {
        "E_i/E_inf": _over(modulus.instantaneous, modulus.relaxed),
        "nu": geometry.material.nu,
        "a/R": _over(largest, geometry.shape.tip_radius),
        "h/a": _over(geometry.target.body_depth, largest),
    }


def _over(value: float | None, unit: float | None) -> float | None:
    return value / unit if value is not None and unit else None


@cache
def provenance() -> Mapping[str, str]:
    """Versions of what computed a result."""
    from importlib.metadata import PackageNotFoundError, version

    found = {"python": platform.python_version(), "platform": platform.platform(terse=True)}
    for package in ("fe-contact", "numpy", "scipy", "scikit-fem", "meshio", "gmsh"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found
