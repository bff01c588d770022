"""The operators behind the buttons: they check, act, and report what happened."""
