"""Error bars: plan, runs, curve, variation, orders, sum."""
