"""What every law and every finite-element run returns: history, quantities, score, ledger, folder."""
