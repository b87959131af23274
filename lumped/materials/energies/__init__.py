"""Elastic energies of large strains, one a file: each has the shear modulus and Poisson's ratio of small ones."""
