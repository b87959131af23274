"""Judgement: what finite elements say of every lumped law, and what accuracy costs; a study a folder, its chart too.

Charts alone import matplotlib. Figures are made without pyplot and hold no global state.
"""

import logging

# Where no home can be written matplotlib keeps its list of fonts elsewhere and warns: nothing that changes a chart.
logging.getLogger("matplotlib").setLevel(logging.ERROR)
