"""The paper's Table 1, F = D(A, R, l) E* depth^alpha "(17)": eight contact geometries, one a file, found by name."""

from lumped.paper.table1.base import Elastic as Elastic
from lumped.paper.table1.base import TableRow as TableRow
from lumped.paper.table1.base import contact_modulus as contact_modulus
from lumped.schema.members import available, get

PACKAGE = "lumped.paper.table1"


def examples() -> tuple[TableRow, ...]:
    """One example of every row, in the order of the table."""
    rows: list[TableRow] = [get(PACKAGE, name).EXAMPLE for name in available(PACKAGE)]
    return tuple(sorted(rows, key=lambda row: row.number))
