"""Ways to keep two surfaces apart, one a file: each offers ``enforce(problem, touching)``.

A member maps a :class:`fe_contact.contact.ContactProblem` and a first guess of the touching points to a
:class:`fe_contact.contact.ContactSolution` and says in ``SOLVES`` how many contact problems it costs.
"""
