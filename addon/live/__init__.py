"""The live relaxation in a window: a run that shows what the worker computes, and operators that listen."""
