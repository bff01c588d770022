"""What is asked of the operating system: files that appear whole or not at all, and signals."""
