"""How geometry sets the exponent: study, check, files, chart."""
