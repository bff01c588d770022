"""What is here runs inside Blender, started by ``tests/window/run``; pytest has nothing to collect."""

collect_ignore_glob = ["*.py"]
