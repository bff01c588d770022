"""What can be pressed: the operators, which check, act, and say what happened."""
