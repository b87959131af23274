"""The chart of one impact: force with its error band, depth and contact radius, contact pressure at the peak."""

from __future__ import annotations

import textwrap
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes

from fe_contact.fields import Pressure, felt, peak_step
from fe_contact.plastic.fields import Dented
from fe_contact.reference import Solved
from fe_contact.studies import style
from fe_contact.studies.style import Look, prefixed, readable, with_error
from lumped.result.history import History
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema.keys import Kind, Number, keys_of

HEIGHT, ABOVE = 2.92, 0.16  # of the panels of one contact, and above them, in
BELOW, LINE = 0.53, 0.115  # below the panels, and a line of the caption there, in
MOST_BAND = 1.25  # times the peak: what is shown of a band that an uncertain time of a later contact makes wide
SETTLED = 0.01  # share of the largest force or depth: what differs less from the end of a history is its tail
TAIL = 1.15  # times the time at which the tail begins: what is shown
MOST_NAMED = 5  # look: contacts that a legend names; of more, the first and the last
BAND_VISIBLE = 0.01  # share of the peak below which the band is a hair line and is drawn magnified
FLIGHT = -0.1  # share of the largest depth below which a body flies
HIGHEST = 1.08  # of the axis of shares of the largest
DENT_SHOWN = 2.5  # contact radii
CAPTION_WIDTH = 78  # characters
CAPTION: Look = {"fontsize": 6.0, "color": "#4d4d4d", "linespacing": 1.4}


def plot_history(
    result: Result, where: Path, solved: Solved | None = None, dented: Dented | None = None
) -> tuple[Path, Path]:
    """Write ``history.svg`` and ``history.png`` into the folder ``where``; their paths.

    The pressure at the peak is drawn where ``solved`` knows one, the march behind a quasi-static result; the surface
    that is left where one is ``dented``; several contacts one over another too.
    """
    beside, several = solved is not None or dented is not None, len(result.contacts) > 1
    heights = (1.6, 1.1, 1.0) if several else (1.6, 1.0)
    told = caption(result.scene)
    look = {"above": ABOVE, "below": BELOW + LINE * len(told.splitlines()), "size": style.COLUMN}
    lines, panels = [_subtitle(result)], HEIGHT * (1.6 if several else 1.0)
    with style.sheet(where, "history", result.scene.name, lines, panels, width=100, **look) as sheet:
        figure, apart = sheet.figure, 0.5 if dented is None else 0.56  # heights below the surface are wide numbers
        grid = sheet.grid(len(heights), 2, 0.15, 0.965, height_ratios=heights, hspace=0.5, wspace=apart)
        _force(figure.add_subplot(grid[0, :]), result)
        if several:
            _contacts(figure.add_subplot(grid[1, :]), result)
        _motion(figure.add_subplot(grid[-1, 0] if beside else grid[-1, :]), result.history, "c" if several else "b")
        if dented is not None:
            _dent(figure.add_subplot(grid[-1, 1]), dented, result.history)
        elif solved is not None:
            _pressure(figure.add_subplot(grid[-1, 1]), _at_peak(solved), "d" if several else "c")
        figure.text(0.023, 0.07 / figure.get_figheight(), told, **CAPTION)
    return sheet.paths


def caption(scene: Scene) -> str:
    """The scene's parameters in two lines or more, of a scene with a geometry; else those of its law."""
    if not scene.has_geometry:
        return _law_alone(scene)
    material, shape, young = scene.geometry.material, scene.geometry.shape, scene.geometry.material.young
    keys = keys_of(type(shape))
    sizes = {key: value for key, value in shape.to_dict().items() if isinstance(value, float)}
    lengths = ", ".join(f"{key} {_size(keys[key].kind, value)}" for key, value in sizes.items())
    terms = [readable(young.equilibrium, "Pa")] if young.equilibrium else []
    pairs = zip(young.moduli, young.times, strict=True)
    terms += [f"{readable(modulus, 'Pa')} exp(−t/{readable(tau, 's')})" for modulus, tau in pairs]
    terms += [f"{readable(young.viscosity, 'Pa s')} δ(t)"] if young.viscosity else []
    more = ", bulk modulus constant" if material.constant == "bulk" else ""
    more += f", yields at {readable(material.yield_strength or 0.0, 'Pa')}" if scene.model.plasticity else ""
    lines = (
        f"{shape.name}, {lengths}, {readable(1e3 * scene.mass, 'g')}, {readable(scene.velocity, 'm/s')}",
        f"on {scene.target.name.replace('_', '-')}: E(t) = {' + '.join(terms)}, ν = {material.nu:g}{more}",
    )
    return "\n".join(part for line in lines for part in textwrap.wrap(line, CAPTION_WIDTH))


def _law_alone(scene: Scene) -> str:
    """What a scene without a geometry tells: mass, velocity and the law's own parameters."""
    moving = f"{readable(1e3 * scene.mass, 'g')}, {readable(scene.velocity, 'm/s')}"
    if scene.law is None:
        return moving
    values = ", ".join(f"{key} = {value}" for key, value in scene.law.values.items())
    return "\n".join(textwrap.wrap(f"{moving}; {scene.law.name.replace('_', ' ')}: {values}", CAPTION_WIDTH))


def _size(kind: Kind, value: float) -> str:
    """A length with a prefixed unit, anything else as it stands in the scene file."""
    unit = kind.unit if isinstance(kind, Number) else ""
    return readable(value, unit) if unit == "m" else f"{value:.3g} {unit}".rstrip()


def _subtitle(result: Result) -> str:
    """Restitution with its bar, and the tolerance."""
    e = result.quantities["restitution"]
    outcome = "no separation" if e.value is None else f"restitution {with_error(e.value, e.error or 0.0)}"
    method = "finite elements" if result.method == "fe" else result.method.replace("_", " ")
    return f"{outcome}; {method}, tolerance {result.tolerance:g}"


def _force(axes: Axes, result: Result) -> None:
    history, end = result.history, _end(result.history)
    second, time_unit = prefixed(end, "s")
    newton, force_unit = prefixed(history.force.max(), "N")
    time, force, error = second * history.time, newton * history.force, newton * history.force_error
    power = _magnification(float(error.max() / force.max()))
    low, high = np.maximum(force - 10.0**power * error, 0.0), force + 10.0**power * error
    top = min(float(high.max()), MOST_BAND * float(force.max()))
    name = "error band" + (f" × $10^{{{power}}}$" if power > 1 else " × 10" if power else "")
    axes.plot(time, force, color=style.BLUE, label="force")
    axes.fill_between(time, low, high, color=style.SKY, alpha=0.55, linewidth=0.0, label=name)
    axes.set(xlabel=f"time, {time_unit}", ylabel=f"force, {force_unit}", xlim=(0, second * end))
    axes.set_ylim(0, 1.2 * top)
    _mark_peak(axes, result, second, newton, top)
    axes.legend(loc="lower right", bbox_to_anchor=(1.02, 1.0), ncols=2, borderaxespad=0.1, columnspacing=1.2)
    style.label(axes, "a", "contact force")


def _end(history: History) -> float:
    """Time until which a history is drawn, s: all of it but the long tail of what comes to rest."""
    columns = (history.force, history.depth)
    far = [np.abs(values - values[-1]) > SETTLED * np.abs(values).max() for values in columns]
    return float(min(history.time[-1], TAIL * history.time[np.any(far, axis=0)].max(initial=0.0)))


def _magnification(bar: float) -> int:
    """Power of ten that makes a band of this share of the peak visible."""
    return 0 if bar <= 0.0 or bar >= BAND_VISIBLE else int(np.ceil(np.log10(BAND_VISIBLE / bar)))


def _mark_peak(axes: Axes, result: Result, second: float, newton: float, above: float) -> None:
    """The peak with its value and bar, written above the band."""
    peak, when = result.quantities["peak_force"], result.quantities["peak_time"]
    if peak.value is None or when.value is None:
        return
    x, y = second * when.value, newton * peak.value
    axes.plot([x], [y], "o", markersize=3.2, color=style.BLUE, markeredgecolor="white", markeredgewidth=0.6)
    text = with_error(peak.value, peak.error or 0.0, "N")
    share = x / axes.get_xlim()[1]
    side, aside = ("left", 3.0) if share < 0.25 else ("right", -3.0) if share > 0.75 else ("center", 0.0)
    axes.annotate(text, (x, above), (aside, 4.0), textcoords="offset points", ha=side, va="bottom", color=style.BLUE)


def _contacts(axes: Axes, result: Result) -> None:
    """Every contact from its touch, one over another: flights are long beside them."""
    history, contacts = result.history, result.contacts
    longest = max(contact["duration"] or 0.0 for contact in contacts)
    second, time_unit = prefixed(longest, "s")
    newton, force_unit = prefixed(history.force.max(), "N")
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, len(contacts)))
    for number, (contact, colour) in enumerate(zip(contacts, colours, strict=True), start=1):
        time = history.time - (contact["start"] or 0.0)
        rows = (time >= 0.0) & (time <= (contact["duration"] or TAIL * longest))
        name = str(number) if len(contacts) <= MOST_NAMED or number in (1, len(contacts)) else None
        axes.plot(second * time[rows], newton * history.force[rows], color=colour, label=name)
    axes.set(xlabel=f"time since its touch, {time_unit}", ylabel=f"force, {force_unit}", ylim=(0, None))
    axes.set_xlim(0, TAIL * second * longest)
    axes.legend(loc="lower right", bbox_to_anchor=(1.02, 1.0), ncols=MOST_NAMED, borderaxespad=0.1, columnspacing=0.9)
    style.label(axes, "b", "each contact")


def _motion(axes: Axes, history: History, letter: str) -> None:
    """Depth and radius in shares of their largest; of what flies, whose heights dwarf them, the depth alone."""
    end = _end(history)
    second, time_unit = prefixed(end, "s")
    axes.set(xlabel=f"time, {time_unit}", xlim=(0, second * end))
    if history.depth.min() < FLIGHT * history.depth.max():
        metre, unit = prefixed(np.abs(history.depth).max(), "m")
        axes.axhline(0.0, color="#4d4d4d", linewidth=0.5)
        axes.plot(second * history.time, metre * history.depth, color=style.VERMILION)
        axes.set_ylabel(f"depth, {unit}", labelpad=0.5)
        style.label(axes, letter, "depth, and flight")
        return
    columns = (("depth", history.depth, style.VERMILION, "-"), ("radius", history.contact_radius, style.GREEN, "--"))
    known = [column for column in columns if np.nanmax(column[1], initial=0.0) > 0.0]  # a bare law has no radius
    for row, (name, values, colour, line) in enumerate(known):
        axes.plot(second * history.time, values / values.max(), color=colour, linestyle=line)
        text = f"{name} / {readable(values.max(), 'm', 3)}"
        axes.text(0.5, 0.21 - 0.13 * row, text, transform=axes.transAxes, color=colour, fontsize=6.2, ha="center")
    axes.set(ylabel="share of largest", ylim=(min(0.0, float(history.depth.min() / history.depth.max())), HIGHEST))
    axes.set_yticks((0.0, 0.5, 1.0))
    style.label(axes, letter, " and ".join(name for name, *_ in known))


def _at_peak(solved: Solved) -> Pressure | None:
    """Pressure at peak force, None where the march tells none."""
    certified = solved.certified
    return felt(certified, peak_step(certified)) if certified.march.snapshots else None


def _dent(axes: Axes, dented: Dented, history: History) -> None:
    """The surface at the largest force and at the end, over the largest depth and contact radius."""
    widest, deepest = np.nanmax(history.contact_radius), history.depth.max()
    radius = dented.radius / widest
    shown = radius <= DENT_SHOWN
    for heights, colour, line, name, place in (
        (dented.pressed, style.GREY, "--", "at the peak", 0.21),
        (dented.left, style.BLUE, "-", "left", 0.34),
    ):
        axes.plot(radius[shown], heights[shown] / deepest, color=colour, linestyle=line)
        axes.text(0.97, place, name, transform=axes.transAxes, color=colour, fontsize=6.2, ha="right")
    axes.set(xlabel=f"radius / {readable(widest, 'm', 3)}", ylabel="height / depth", xlim=(0, DENT_SHOWN))
    style.label(axes, "c", "indentation left")


def _pressure(axes: Axes, pressure: Pressure | None, letter: str) -> None:
    style.label(axes, letter, "pressure at peak")
    if pressure is None:
        axes.set_axis_off()
        axes.text(0.0, 0.8, "under a flat end:\nthat of the indentation", transform=axes.transAxes)
        return
    pascal, unit = prefixed(pressure.values.max(), "Pa")
    edge = pressure.contact_radius
    metre, length_unit = prefixed(edge, "m")
    radii = edge * np.append(np.sin(np.linspace(0.0, np.pi / 2, 200)[:-1]), 1.0)
    values = pascal * pressure.at(radii)
    values[-1] = 0.0
    axes.fill_between(metre * radii, values, color=style.SKY, alpha=0.35, linewidth=0.0)
    axes.plot(metre * radii, values, color=style.BLUE)
    axes.set(xlabel=f"radius, {length_unit}", ylabel=f"pressure, {unit}", xlim=(0, 1.12 * metre * edge))
    axes.set_ylim(0, 1.12 * values.max())
