"""The source paper's numbers: every claim recomputed and judged by rule, its misprints, its assumptions.

Xue, Zhang, He, Zou and Zhang 2016, doi 10.1155/2016/2596923; the data lie in `data/paper/`.
"""

from lumped.paper.claims import Claim as Claim
from lumped.paper.claims import JudgedClaim as JudgedClaim
from lumped.paper.given import Examples as Examples
from lumped.paper.value import Value as Value
