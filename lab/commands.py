"""The commands of the laboratory, which the command line finds by entry points; each imports what it needs itself."""

import argparse

_BATCH = """\
examples:
  mobius-flow batch 3_1..7_7 -o results --starts 3
  mobius-flow batch curves/ "more/*.obj" trefoil "T(3,5)" -o results --time-limit 600
  mobius-flow batch 3_1..10_165 -o /shared/results --scheduler tcp://head:8786 --extrapolate
  mobius-flow batch 3_1..10_165 L2a1..L9n28 -o tight --tighten --starts 10

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
_ATLAS = """\
examples:
  mobius-flow batch 3_1..7_7 -o results --starts 10 --extrapolate --escape-saddles
  mobius-flow atlas results -o atlas
  mobius-flow gallery atlas -o poster.png --only 3_1,4_1,5_1,5_2

Runs count that ended as a knot or link of the table, which is proved or was made by that name, and whose smooth shape
batch found; mirror images are turned over. Reports are not believed: trajectories are verified once more, and must end
at the curve, which like the smooth shape must be of that type; and this must be at rest with the energy reported. Those
of equal energy, whose shapes are the same up to Möbius maps and isometries, have met the same minimum.

DIR has pages (index.html), and in DIR/data tables, curves and their description, also as one archive to be deposited.
The same command again does what is new. Only what atlas wrote is replaced or removed; DIR/SHA256SUMS lists it. Pictures
need Blender's Python module, and take some ten seconds of processor time each.

exit status: 0; 2 where no run counts, files of others are in the way, or DIR cannot be written; 130 interrupted
"""
_GALLERY = """\
examples:
  mobius-flow batch 3_1..7_7 -o results && mobius-flow gallery results -o gallery.png
  mobius-flow gallery atlas -o poster.png --only 3_1,4_1,5_1,7_4,8_18,L6a4 --look studio --size 1200

Converged curves are shown as the Möbius image, of the same energy, that bends least, but for open ones and those that
were pinned or had obstacles. A picture takes some two seconds of processor time, and more if it is larger. The energy
is that of the smooth curve, with its error, where batch was told to --extrapolate it.

exit status: 0; 2 where there are no results, something is not installed, or OUT cannot be written; 130 interrupted
"""
_COMPARE = """\
examples:
  mobius-flow compare knot.txt
  mobius-flow compare knot.txt --methods lbfgs,flow-moebius,flow-l2 --time-limit 20 -o figure.png
  mobius-flow compare knot.txt --methods flow-moebius,flow-l2 --strip 0,5,20,80 -o strip.png

Figure 3 of the paper, in which colours are metrics:
  mobius-flow compare knot.txt -o figure.png \\
      --methods 'flow-*,implicit-l2,trust-region,penalty-lbfgs:*,penalty-cg:*,penalty-nesterov:*'

A table of how each method ended is printed. A figure shows the energy, its distance to the least one, and the gradient
norm, each over iterations and over seconds of processor time, which a busy machine does not change. The objective
(column, or key, "energy" of a file) is the energy with the barrier between near strands, without the penalty of the
methods that have one. The least one is taken over the methods that keep lengths. Methods take no other steps than their
own, but where one is stuck a fallback method takes over: "fallback" counts or marks its steps, which are dots in a
figure. When its time is up, a method is stopped even in the middle of a step.

exit status: 0; 2 on bad input or bad options, or where OUT cannot be written; 130 interrupted, where the methods that
are done are written all the same
"""


def add_batch(parser: argparse.ArgumentParser) -> None:
    """Relax many curves, on all cores or a cluster."""
    from ..cli import options as relax_options
    from .batch.campaign import campaign

    parser.description = "Relax many curves, each in a folder of its own, and write one table of the results."
    parser.epilog = _BATCH
    text = "curve files, directories of them, patterns, names of knots, ranges of the table such as 3_1..8_21"
    parser.add_argument("inputs", metavar="INPUT", nargs="+", help=text)
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="directory of the results")
    parser.add_argument("--starts", type=int, default=1, metavar="K", help="runs per input (default: 1)")
    text = "pull knots tight instead, on 800 vertices unless told otherwise, each in one run whose K starts compete"
    parser.add_argument("--tighten", action="store_true", help=text)
    text = "also tell the energy of the smooth curve that finer meshes lead to"
    parser.add_argument("--extrapolate", action="store_true", help=text)
    text = "address of a running Dask scheduler (default: use all cores of this machine)"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=text)
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    relax_options.add_to(parser)
    relax_options.add_task(parser)
    parser.set_defaults(run=campaign, radius="none")  # of minima alone, which come sooner without a rope


def add_atlas(parser: argparse.ArgumentParser) -> None:
    """Make pages and tables of the minima that batches found."""
    from ..cli.options import DEFAULT, look
    from .atlas.make import NO_LOOK, make

    parser.description, parser.epilog = "Make pages and a package of data from the results of batches.", _ATLAS
    parser.add_argument("results", metavar="RESULTS", nargs="+", help="directory that mobius-flow batch wrote to")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="directory of the atlas")
    text = f"look of the pictures, as for relax, or {NO_LOOK} (default: {DEFAULT.lower()} where bpy is installed)"
    parser.add_argument("--look", type=lambda word: look(word, NO_LOOK), metavar="LOOK", help=text)
    parser.set_defaults(run=make)


def add_gallery(parser: argparse.ArgumentParser) -> None:
    """Show the results of a batch."""
    from ..cli import options as relax_options
    from .gallery import gallery

    parser.description, parser.epilog = "Show all results of a batch, or knots of an atlas, on one page.", _GALLERY
    text = "directory that mobius-flow batch or mobius-flow atlas wrote to"
    parser.add_argument("results", metavar="RESULTS", help=text)
    parser.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the page")
    parser.add_argument("--only", metavar="A,B,…", help="names of what is shown, in this order (default: all)")
    parser.add_argument("--look", type=relax_options.look, metavar="LOOK", help="look of the pictures, as for relax")
    parser.add_argument("--size", type=int, default=300, metavar="N", help="pixels of a picture (default: 300)")
    parser.set_defaults(run=gallery)


def add_compare(parser: argparse.ArgumentParser) -> None:
    """Compare descent methods on a curve."""
    from ..cli import curves
    from ..cli import options as relax_options
    from .compare.command import WRITERS, compare, usual
    from .compare.comparison import LEFT_OUT

    parser.description = "Compare methods on a curve: energy and gradient against iterations and seconds."
    parser.epilog = _COMPARE
    curves.add_input(parser, "polygons, closed or open")
    text = "names, or METHOD:METRIC, comma separated; * in either stands for all that fit"
    parser.add_argument("--methods", metavar="A,B,…", help=f"{text} (default: {','.join(usual())})")
    limit = "limit per method, in seconds, as for relax (default: 30)"
    parser.add_argument("--time-limit", type=float, default=30.0, metavar="SECONDS", help=limit)
    strip = "instead of graphs, draw the curves after these numbers of iterations, one row per method"
    parser.add_argument("--strip", metavar="K,K,…", help=strip)
    parser.add_argument("-o", "--output", metavar="OUT", help=f"figure, or table of all iterates: {', '.join(WRITERS)}")
    relax_options.add_to(parser, without=("method", *LEFT_OUT))
    relax_options.add_task(parser)
    parser.set_defaults(run=compare)


def add_methods(parser: argparse.ArgumentParser) -> None:
    """List the descent methods."""
    from .compare.command import methods

    parser.description = "List the descent methods: name, a tab, what it is; those for comparison come last."
    parser.epilog = "exit status: 0"
    parser.set_defaults(run=methods)
