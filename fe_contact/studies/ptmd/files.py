"""A study of the pounding tuned mass damper as files: rows and contacts in CSV, what they amount to in JSON."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np

from lumped.ptmd.case import Case
from lumped.ptmd.result import COLUMNS
from lumped.ptmd.study import SMALL, PtmdStudy
from lumped.result.folder import publish
from lumped.result.result import provenance
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA, RECORD = "fe-contact/ptmd/1", "ptmd.json"
CONTACT_COLUMNS = {
    "side": "side",
    "start": "start_s",
    "end": "end_s",
    "peak_force": "peak_force_N",
    "peak_depth": "peak_depth_m",
}


def write_study(study: PtmdStudy, where: Path) -> Table:
    """Write ``ptmd.csv``, ``contacts.csv`` and ``ptmd.json`` into a folder; the content of the last."""
    motion = study.main.motion
    table = np.column_stack([getattr(motion, name) for name in COLUMNS])
    write_csv(where / "ptmd.csv", list(COLUMNS.values()), table.tolist())
    rows = [[getattr(contact, name) for name in CONTACT_COLUMNS] for contact in study.main.contacts]
    write_csv(where / "contacts.csv", list(CONTACT_COLUMNS.values()), rows)
    content = study_content(study)
    write_json(where / RECORD, content)
    return content


def write_failure(case: Case, message: str, where: Path) -> None:
    """Write the ``ptmd.json`` of a motion that was not followed to its end: what is known. Raises CannotWrite."""
    content = {"schema": SCHEMA, "name": case.name, "converged": False, "model_sufficient": None, "message": message}
    known = plain(content | {"case": case.to_dict(), "provenance": provenance()})
    publish(where, lambda folder: write_json(folder / RECORD, known), RECORD)


def study_content(study: PtmdStudy) -> Table:
    """The content of ``ptmd.json``; SI units, null where undefined."""
    message = study.convergence.message
    content: Table = plain(
        {
            "schema": SCHEMA,
            "name": study.case.name,
            "converged": not message,
            "model_sufficient": study.model_sufficient,
            "message": message,
            "case": study.case.to_dict(),
            "measures": study.main.measures.to_dict(),
            "energy": study.main.energy.to_dict(),
            "variants": {name: result.measures.to_dict() for name, result in study.results.items()},
            "convergence": asdict(study.convergence),
            "model_ledger": [entry.to_json(SMALL) for entry in study.ledger],
            "provenance": provenance(),
        }
    )
    return content
