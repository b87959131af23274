"""The method of dimensionality reduction: the half-space as a row of independent springs. numpy only.

Popov and Hess 2015, ISBN 978-3-642-53876-6; Argatov and Popov 2016, doi 10.1002/zamm.201500144. A spring
stands at every place x of a line and carries, per length, the relaxation series of depth - g(x), g the
equivalent profile; F = 2 int_0^edge f dx. A spring joins when the profile touches it, and leaves when its
force reaches zero.
"""
