"""One contact from touch to separation, flights between, the energy account."""
