"""The free vibration of a pounding tuned mass damper, by either route."""

from __future__ import annotations

from lumped.errors import BadInput, Fault, nearest
from lumped.ptmd import reading
from lumped.ptmd.equations import Equations
from lumped.ptmd.march import march, most_rows, route_of
from lumped.ptmd.phase import ROWS_PER_PERIOD, row_spacing
from lumped.ptmd.result import PtmdResult
from lumped.ptmd.system import PoundingDamper, Start
from lumped.ptmd.track import PtmdTrack
from lumped.schema.key_table import read_table
from lumped.schema.keys import Number

ROUTES = ("exact", "integrated")
TIME_KEYS = {"end_time": Number(1e-9, 1e9, "s"), "window": Number(1e-9, 1e9, "s")}


def simulate(
    system: PoundingDamper,
    start: Start,
    end_time: float = 20.0,
    window: float = 5.0,
    route: str | None = None,
    rows_per_period: int = ROWS_PER_PERIOD,
) -> PtmdResult:
    """Vibration from `start` to `end_time`, s; root mean squares over the first `window` seconds.

    `route`: "exact" (default for exponent 1: matrix exponentials between located switches) or "integrated"
    (any exponent: DOP853). Rows lie `rows_per_period` to the shortest period. Raises BadInput and NotReached.
    """
    _, faults = read_table("simulate", "", {"end_time": end_time, "window": window}, TIME_KEYS)
    equations = Equations(system)
    route = route or ("exact" if equations.linear else "integrated")
    if route not in ROUTES:
        faults.append(Fault("simulate", "route", f"accepted: {', '.join(ROUTES)}{nearest(route, ROUTES)}"))
    elif route == "exact" and not equations.linear:
        faults.append(Fault("simulate", "route", "exact only for exponent 1; accepted here: integrated"))
    if system.damper is None and not (start.x1 or start.v1):
        faults.append(Fault("start", "x1", "nothing moves without a damper; accepted: x1 or v1 that is not zero"))
    if faults:
        raise BadInput(faults)
    spacing = row_spacing(equations, start, end_time, rows_per_period, most_rows(route))
    follow = route_of(route, equations, start, spacing, end_time)
    track = PtmdTrack(equations, march(equations, start, end_time, follow))
    found = reading.contacts(track)
    return PtmdResult(
        system=system,
        start=start,
        motion=reading.motion(track),
        contacts=found,
        energy=reading.energy(track),
        measures=reading.measures(track, found, window),
    )
