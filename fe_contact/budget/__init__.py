"""Error bars: an impact is planned, run, run again with one setting varied at a time, and what changes is summed.

The formula of a bar, SAFETY/(2^order - 1) times the change, is ``factor`` in ``variation``; ``certify`` says which
changes an impact's bars are made of, ``curve`` how two marches are compared, ``runs`` makes each of them once;
``budget`` sums the causes, ``several`` follows contact after contact, ``refine`` goes on until a tolerance is met.
"""
