"""Many runs, each in a folder of its own, on all cores of one machine or on a cluster."""
