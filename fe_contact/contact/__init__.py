"""``problem``: the contact problem, its Newton and its line search, and where the contact's edge lies; ``enforcement``,
one law a file.
"""
