"""What a computation takes: wall time, and process time, which other work on the machine does not lengthen."""

from __future__ import annotations

from time import perf_counter, process_time


class Clock:
    """Wall and process time since it was made."""

    def __init__(self) -> None:
        self.wall, self.cpu = perf_counter(), process_time()

    def read(self) -> dict[str, float]:
        """Seconds, as `timing` of a result has them."""
        return {"wall_s": perf_counter() - self.wall, "cpu_s": process_time() - self.cpu}
