"""Fitting a law to a history: what its parameters are, how well they are known, and how far it still errs."""

from lumped.fit.record import Estimate as Estimate
from lumped.fit.record import Fit as Fit
from lumped.fit.record import write_failure as write_failure
from lumped.fit.search import fit as fit
