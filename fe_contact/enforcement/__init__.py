"""Ways to keep two surfaces apart, one a file: each offers ``enforce(problem, *guesses)``.

A member maps a :class:`fe_contact.contact.ContactProblem` and first guesses of the touching points, one or one
for each contact problem it solves, to a :class:`fe_contact.contact.ContactSolution`. It says in ``SOLVES`` how many
contact problems it costs at most. A member whose pressure follows from the overlap alone also offers
``signed_pressure(overlap, penalty)``.
"""
