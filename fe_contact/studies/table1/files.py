"""What ``fe-contact table1`` writes: a line a row, a line a datum or layer, and everything as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from fe_contact.studies.table1.blocks import Block
from fe_contact.studies.table1.datum import DEPTH
from fe_contact.studies.table1.impact import FromImpact
from fe_contact.studies.table1.study import Trial, bodies
from fe_contact.studies.table1.verdict import Deviation, deviations, verdict
from lumped.result.result import Quantity
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/table1/1"
COLUMNS = (
    "number", "row", "case", "D_printed_formula", "D_printed", "D", "D_error", "D_deviation", "alpha_printed", "alpha",
    "alpha_error", "E_printed_formula", "E_corrected_formula", "nu", "E_printed_Pa", "E_Pa", "E_error_Pa",
    "E_deviation", "depth_tried_from", "depth_tried_to", "holds_to_1_percent_up_to", "holds_up_to_error", "verdict",
    "statement", "validity", "correction", "D_impact", "D_impact_error", "alpha_impact", "alpha_impact_error",
    "E_impact_Pa", "E_impact_error_Pa",
)  # fmt: skip
DATUM_COLUMNS = ("number", "row", "support", "length_over_radius", "method", "D_over_l", "D_over_l_error", "alpha",
                 "alpha_error", "depth_over_radius_with_printed_D")  # fmt: skip

BONDED_COLUMNS = ("nu", "radius_over_thickness", "modulus_over_young", "modulus_over_young_error")


def write_table1(trials: Sequence[Trial], where: Path) -> dict[str, Any]:
    """Write ``table1.csv``, ``-datum.csv``, ``-bonded.csv`` and ``table1.json`` into a folder; the latter's content."""
    where.mkdir(parents=True, exist_ok=True)
    write_csv(where / "table1.csv", COLUMNS, [_line(trial) for trial in trials])
    stuck = {block: None for trial in trials for block in trial.bonded}
    write_csv(where / "table1-bonded.csv", BONDED_COLUMNS, [_block(block) for block in stuck])
    write_csv(where / "table1-datum.csv", DATUM_COLUMNS, [line for trial in trials for line in _data(trial)])
    content: dict[str, Any] = plain({"schema": SCHEMA, "rows": [_described(trial) for trial in trials]})
    write_json(where / "table1.json", content)
    return content


def _line(trial: Trial) -> list[Any]:
    """One row of table1.csv; E* at the Poisson's ratio where it lies farthest from the printed one."""
    row, printed, judged = trial.row, deviations(trial), verdict(trial)
    nu = max(trial.moduli, key=lambda one: _off(trial, one), default=None)
    known = None if nu is None else row.printed_modulus(*bodies(row, nu))
    reach = trial.reach
    return [
        row.number, row.name, row.case,
        row.printed[0], row.factor, *_pair(trial.factor), _value(printed, "D"),
        row.alpha, *_pair(trial.alpha),
        row.printed[1], row.corrected[1], nu, known, *_pair(None if nu is None else trial.moduli[nu]),
        _value(printed, "E*"),
        *((None, None, None, None) if reach is None else (reach.first, reach.last, *_pair(reach.held))),
        judged.word, judged.sentence, row.validity, row.correction or None, *_struck(trial, nu),
    ]  # fmt: skip


def _struck(trial: Trial, nu: float | None) -> tuple[float | None, ...]:
    """D, alpha and E* at a Poisson's ratio from impacts, each with its bar."""
    found = trial.impact
    if found is None:
        return (None,) * 6
    return (*_pair(found.factor), *_pair(found.alpha), *_pair(None if nu is None else found.moduli[nu]))


def _data(trial: Trial) -> list[list[Any]]:
    """Its rows of table1-datum.csv."""
    return [
        [trial.row.number, trial.row.name, place.support, place.length, place.method, *_pair(place.factor),
         *_pair(place.alpha), place.once]
        for place in trial.datum
    ]  # fmt: skip


def _block(block: Block) -> list[float]:
    """One row of table1-bonded.csv."""
    young, modulus = block.body.young, block.modulus
    return [block.body.nu, block.width, (modulus.value or 0.0) / young, (modulus.error or 0.0) / young]


def _described(trial: Trial) -> dict[str, Any]:
    """One row of table1.json."""
    row, reach = trial.row, trial.reach
    return {
        "number": row.number,
        "row": row.name,
        "case": row.case,
        "geometry": row.to_dict(),
        "young_Pa": [body.young for body in bodies(row, 0.0)],
        "printed": {"D": row.printed[0], "E*": row.printed[1], "alpha": row.alpha, "D_value": row.factor},
        "corrected": {"D": row.corrected[0], "E*": row.corrected[1], "alpha": row.alpha if row.single else None},
        "validity": row.validity,
        "correction": row.correction or None,
        "alpha": None if trial.alpha is None else asdict(trial.alpha),
        "D": None if trial.factor is None else asdict(trial.factor),
        "E*": [_modulus(trial, nu, found) for nu, found in trial.moduli.items()],
        "impact": None if trial.impact is None else _from_impact(trial.impact),
        "reach": None if reach is None else _reach(trial),
        "datum": [asdict(place) for place in trial.datum],
        "datum_depth_over_radius": DEPTH if trial.datum else None,
        "bonded": [
            {"nu": block.body.nu, "radius_over_thickness": block.width, **asdict(block.modulus)}
            for block in trial.bonded
        ],
        "deviations": {name: asdict(one) for name, one in deviations(trial).items()},
        "verdict": asdict(verdict(trial)),
        "failure": trial.failure or None,
    }


def _from_impact(found: FromImpact) -> dict[str, Any]:
    moduli = [{"nu": nu, **asdict(modulus)} for nu, modulus in found.moduli.items()]
    single = {name: None if one is None else asdict(one) for name, one in (("alpha", found.alpha), ("D", found.factor))}
    return {**single, "E*": moduli}


def _modulus(trial: Trial, nu: float, found: Quantity) -> dict[str, Any]:
    row, pressed = trial.row, bodies(trial.row, nu)
    known = {"printed": row.printed_modulus(*pressed), "corrected": row.modulus(*pressed)}
    return {"nu": [body.nu for body in pressed], **asdict(found), **known}


def _reach(trial: Trial) -> dict[str, Any]:
    reach = trial.reach
    assert reach is not None
    curve = {"depth": reach.depth.tolist(), "departure": reach.departure.tolist()}
    ends = {"first": reach.first, "last": reach.last, "held": asdict(reach.held), "throughout": reach.throughout}
    return {"length": trial.row.length_name or "m", **ends, **curve}


def _off(trial: Trial, nu: float) -> float:
    known = trial.row.printed_modulus(*bodies(trial.row, nu))
    return abs((trial.moduli[nu].value or 0.0) / known - 1.0)


def _pair(quantity: Quantity | None) -> tuple[float | None, float | None]:
    return (None, None) if quantity is None else (quantity.value, quantity.error)


def _value(found: Mapping[str, Deviation], name: str) -> float | None:
    return found[name].value if name in found else None
