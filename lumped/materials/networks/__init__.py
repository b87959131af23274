"""Spring-dashpot networks, one a file: `KEYS`, the alternative sets of keys, and `of(**values)`.

`of` returns the Relaxation of the network and raises ValueError, with a message, for values which make none.
"""
