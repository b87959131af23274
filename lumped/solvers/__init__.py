"""How a force law is followed: mass on one contact, Ting's integrals, a row of springs, waves of rods and bars."""
