"""nullpose measured: against its peers, against the clock, against its own past. See README.md here."""
