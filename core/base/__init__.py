"""What every room stands on: errors, messages, checked arguments, files, time, threads, types of arrays."""
