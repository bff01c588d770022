"""``mobius-flow batch``: relax tables of knots, on all cores of one machine or on a cluster."""

import argparse

from .. import options as relax_options

_EPILOG = """\
examples:
  mobius-flow batch 3_1..7_7 -o results --starts 3
  mobius-flow batch curves/ "more/*.obj" trefoil "T(3,5)" -o results --time-limit 600
  mobius-flow batch 3_1..10_165 -o /shared/results --scheduler tcp://head:8786 --extrapolate

Start 1 is the input. Start k above 1 is the same knot, scrambled with seed S + k by random moves that are each checked
to be an isotopy; knots of the table have starts of several kinds. A run that is refused, killed or too slow gets a row
that says why; the others go on.

DIR/NAME, or DIR/NAME-k for start k above 1, holds curve.txt, report.json and trajectory.npz, and appears whole or not
at all. The table, DIR/results.csv and DIR/results.parquet, has a row for each run of the command. The same command
again skips what is finished (the same input, options and version) and retries what failed. Only what batch wrote
is replaced. On a cluster DIR and the input files are on a file system that all machines share.

exit status:
  0    every run has its row, also if some of them failed: the rows and the last line say so
  1    memory ran out
  2    bad options, inputs that name nothing, files of others in the way, results that cannot be written, or a cluster
       that does not answer or is lost; one line says which
  130  interrupted; the table has what is finished
"""


def add_batch(parser: argparse.ArgumentParser) -> None:
    """Describe ``batch``."""
    parser.description = "Relax many curves, each in a folder of its own, and write one table of the results."
    parser.epilog = _EPILOG
    text = "curve files, directories of them, patterns, names of knots, ranges of the table such as 3_1..8_21"
    parser.add_argument("inputs", metavar="INPUT", nargs="+", help=text)
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="directory of the results")
    parser.add_argument("--starts", type=int, default=1, metavar="K", help="runs per input (default: 1)")
    text = "also tell the energy of the smooth curve that finer meshes lead to"
    parser.add_argument("--extrapolate", action="store_true", help=text)
    text = "address of a running Dask scheduler (default: use all cores of this machine)"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=text)
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    relax_options.add_to(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from .campaign import campaign

    campaign(options)
    return 0
