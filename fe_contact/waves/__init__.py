"""Impacts on bodies with inertia: plan, march, error bars, and the record of what was found."""
