"""Laws calibrated at one state and used at others: study, verdict, chart."""
