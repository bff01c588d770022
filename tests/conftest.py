"""What every test needs before it starts."""

import os

# as the command line does: two spinning BLAS thread pools would make the tests crawl on a busy machine
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
