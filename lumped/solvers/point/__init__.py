"""Two masses and a force law: the impact marched by collocation, its events located exactly."""
