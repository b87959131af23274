"""The rows of Table 1 on trial: study, verdict, files, chart."""
