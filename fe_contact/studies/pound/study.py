"""A study of pounding structures, written and told: rows and contacts in CSV, what they come to in JSON."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fe_contact.studies.files import Line, lines_of, write_study
from lumped.pounding.case_file import PoundingCase
from lumped.pounding.simulation import FrameContact, FramesResult
from lumped.pounding.study import NO_CONTACT, Pounding, PoundStudy
from lumped.result.folder import publish
from lumped.result.result import provenance
from lumped.schema import Table

SCHEMA, RECORD = "fe-contact/pound/1", "pound.json"
UNITS = {
    "peak_drift": "m", "peak_displacement": "m", "peak_acceleration": "m/s2", "peak_force": "N", "impulse": "N s",
    "contacts": "1",
}  # fmt: skip
CONTACT_COLUMNS = {
    "start": "start_s",
    "end": "end_s",
    "peak_force": "peak_force_N",
    "peak_time": "peak_time_s",
    "impulse": "impulse_N_s",
    "closing": "closing_m_per_s",
    "restitution": "restitution",
}


def write_pound(study: PoundStudy, where: Path, beside: Table | None = None) -> Table:
    """Write ``response.csv``, ``contacts.csv`` and ``pound.json`` into a folder; the content of the last.

    The rows of other laws go into ``response-<law>.csv``. SI units, null where undefined. ``beside``: what else the
    record is to say.
    """
    content = {
        "schema": SCHEMA,
        "name": study.case.name,
        "converged": not study.message,
        "message": study.message,
        "case": study.case.to_dict(),
        "laws": {name: _motion(study.case, motion) for name, motion in study.motions.items()},
        NO_CONTACT.replace(" ", "_"): {
            "measures": {name: {"value": value, "unit": UNITS[name]} for name, value in study.apart.measures().items()},
            "storeys": _storeys(study.apart),
            "energy": study.apart.energy.to_dict(),
        },
        "provenance": provenance(),
        **(beside or {}),
    }
    tables = {"response": lines_of(dict(_columns(study.main)))}
    for name, motion in list(study.motions.items())[1:]:
        tables[f"response-{name}"] = lines_of(dict(_columns(motion.result)))
    tables["contacts"] = [
        _contact(name, motion.result, contact)
        for name, motion in study.motions.items()
        for contact in motion.result.contacts
    ]
    header = ["law", "gap", "left_storey", "right_storey", *CONTACT_COLUMNS.values()]
    return write_study(where, "pound", content, tables, {"contacts": header})


def write_failure(case: PoundingCase, message: str, where: Path) -> None:
    """Write the ``pound.json`` of a motion that was not followed to its end: what is known. Raises CannotWrite."""
    content = {"schema": SCHEMA, "name": case.name, "converged": False, "message": message}
    known = content | {"case": case.to_dict(), "provenance": provenance()}
    publish(where, lambda folder: write_study(folder, "pound", known, {}), RECORD)


def _motion(case: PoundingCase, motion: Pounding) -> Table:
    """What happened under one law."""
    result = motion.result
    measures = {
        name: {"value": value, "error": motion.errors[name], "unit": UNITS[name]}
        for name, value in result.measures().items()
    }
    parameters = {gap: law.parameters for gap, law in zip(case.frames.gaps, motion.laws, strict=True)}
    return {
        "converged": not motion.message,
        "parameters": parameters,
        "measures": measures,
        "gaps": {gap: _gap(result, gap) for gap in case.frames.gaps},
        "storeys": _storeys(result),
        "energy": result.energy.to_dict(),
        "work": {"steps": result.steps, "pressed_steps": result.pressed_steps},
    }


def _gap(result: FramesResult, gap: str) -> Table:
    """The contacts of one gap together."""
    own = [contact for contact in result.contacts if contact.gap == gap]
    return {
        "contacts": len(own),
        "impulse": sum(contact.impulse for contact in own),
        "peak_force": max((contact.peak_force for contact in own), default=0.0),
    }


def _storeys(result: FramesResult) -> Table:
    """The peaks of every storey by its name."""
    return dict(zip(result.frames.storeys, result.peaks, strict=True))


def _columns(result: FramesResult) -> Iterator[tuple[str, object]]:
    """The rows of a motion, column by column."""
    motion = result.motion
    yield "time_s", motion.time
    yield "ground_m_per_s2", motion.ground
    for i, name in enumerate(result.frames.storeys):
        yield f"{name}_displacement_m", motion.displacement[:, i]
        yield f"{name}_drift_m", motion.drift[:, i]
        yield f"{name}_acceleration_m_per_s2", motion.acceleration[:, i]
    for i, gap in enumerate(result.frames.gaps):
        yield f"{gap}_force_N", motion.force[:, i]


def _contact(law: str, result: FramesResult, contact: FrameContact) -> Line:
    gap = result.frames.gaps[contact.gap]
    place = {"law": law, "gap": contact.gap, "left_storey": gap.left, "right_storey": gap.right}
    return place | {column: getattr(contact, name) for name, column in CONTACT_COLUMNS.items()}


def told(study: PoundStudy) -> list[str]:
    """The measures under every law and without contact, then the energies of the first, one a line."""
    lines = []
    for name, result in motions_of(study).items():
        m = result.measures()
        said = f"{name:17s} peak drift {1e3 * m['peak_drift']:.4g} mm, acceleration {m['peak_acceleration']:.4g} m/s2"
        if name != NO_CONTACT:
            said += f", {m['contacts']} contacts, peak force {1e-3 * m['peak_force']:.4g} kN"
            if result.frames.slabs:
                said += f" +- {study.motions[name].relative:.1%}"
            said += f", impulse {1e-3 * m['impulse']:.4g} kN s"
        lines.append(said)
    energy = study.main.energy
    lines.append(
        f"of {energy.initial + energy.input:.4g} J that came in, lost in structures {energy.damping:.4g}, in contacts "
        f"{energy.contact:.4g}; residual {energy.residual:.1e}"
    )
    return lines


def motions_of(study: PoundStudy) -> dict[str, FramesResult]:
    """All motions by their names, that without contact last."""
    return {name: motion.result for name, motion in study.motions.items()} | {NO_CONTACT: study.apart}
