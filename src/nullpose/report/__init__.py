"""What was found, as tables, figures and verdicts; nothing here is imported before it is needed."""
