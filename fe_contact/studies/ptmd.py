"""A study of the pounding tuned mass damper, written and told: rows and contacts in CSV, what they come to in JSON."""

from __future__ import annotations

from pathlib import Path

from fe_contact.studies.files import Line, lines_of, write_study
from lumped.ptmd.case_file import Case
from lumped.ptmd.result import COLUMNS
from lumped.ptmd.study import SMALL, PtmdStudy
from lumped.result.folder import publish
from lumped.result.result import provenance, worst
from lumped.schema import Table

SCHEMA, RECORD = "fe-contact/ptmd/1", "ptmd.json"
CONTACT_COLUMNS = {
    "side": "side",
    "start": "start_s",
    "end": "end_s",
    "peak_force": "peak_force_N",
    "peak_depth": "peak_depth_m",
}


def write_ptmd(study: PtmdStudy, where: Path) -> Table:
    """Write ``ptmd.csv``, ``contacts.csv`` and ``ptmd.json`` into a folder; the content of the last.

    SI units, null where undefined.
    """
    main, message = study.main, study.convergence.message
    content = {
        "schema": SCHEMA,
        "name": study.case.name,
        "converged": not message,
        "model_sufficient": study.model_sufficient,
        "message": message,
        "case": study.case.to_dict(),
        "measures": main.measures,
        "energy": main.energy.to_dict(),
        "variants": {name: result.measures for name, result in study.results.items()},
        "convergence": study.convergence,
        "model_ledger": [entry.to_json(SMALL) for entry in study.ledger],
        "provenance": provenance(),
    }
    rows = lines_of({column: getattr(main.motion, name) for name, column in COLUMNS.items()})
    contacts: list[Line] = [
        {column: getattr(one, name) for name, column in CONTACT_COLUMNS.items()} for one in main.contacts
    ]
    tables = {"ptmd": rows, "contacts": contacts}
    return write_study(where, "ptmd", content, tables, {"contacts": CONTACT_COLUMNS.values()})


def write_failure(case: Case, message: str, where: Path) -> None:
    """Write the ``ptmd.json`` of a motion that was not followed to its end: what is known. Raises CannotWrite."""
    content = {"schema": SCHEMA, "name": case.name, "converged": False, "model_sufficient": None, "message": message}
    known = content | {"case": case.to_dict(), "provenance": provenance()}
    publish(where, lambda folder: write_study(folder, "ptmd", known, {}), RECORD)


def told(found: PtmdStudy) -> list[str]:
    """The measures of every variant, then the energies, one a line."""
    lines = []
    for name, result in found.results.items():
        m = result.measures
        halved = "not reached" if m.t50 is None else f"{m.t50:.3g} s"
        lines.append(
            f"{name:19s} rms x1 {1e3 * m.rms_displacement:.4g} mm over the first {m.window:.3g} s, "
            f"max |a1| {m.max_acceleration:.4g} m/s2, "
            f"last above 50 % {halved}, contacts {m.contacts}"
        )
    m, energy = found.main.measures, found.main.energy
    lines.append(f"peak force {m.peak_force:.4g} N, penetration {1e3 * m.peak_depth:.4g} mm")
    lines.append(
        f"of {energy.initial:.4g} J lost in structure {energy.lost_structure:.4g}, damper {energy.lost_damper:.4g}, "
        f"ring {energy.lost_ring:.4g}; residual {energy.residual:.1e}"
    )
    return lines


def assumption(found: PtmdStudy) -> str:
    """By how much an assumption of the contact law does not hold."""
    most = worst(found.ledger)
    return f"the contact law assumes small deformation: {most.effect} is {most.estimate:.2g}"
