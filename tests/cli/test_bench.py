"""``mobius-flow bench``: a row per curve, and an exit status that tells whether all is well."""

import pytest
from mobius_flow.cli.main import main


def test_rows_and_status(capsys):
    assert main(["bench", "knots", "--only", "3_1, L2a1", "--tolerance", "1e-2"]) == 0
    header, trefoil, hopf = capsys.readouterr().out.splitlines()
    assert header.split()[:3] == ["curve", "vertices", "type"]
    assert trefoil.startswith("3_1 ")
    assert " kept " in trefoil
    assert " yes " in hopf


def test_columns_are_as_wide_as_names(capsys):
    names = ["unknot-freedman-he-wang", "3_1"]
    assert main(["bench", "knots", "--only", ",".join(names), "--max-iterations", "0"]) == 1
    header, *rows = capsys.readouterr().out.splitlines()
    end = header.index(" type") + len(" type")
    assert [row[:end].split()[-1] for row in rows] == ["unknot", "kept"]
    assert all(row[end] == " " for row in rows)


def test_an_unknot_that_is_no_circle_fails(capsys):
    assert main(["bench", "knots", "--only", "unknot-lattice-20", "--max-iterations", "1"]) == 1
    assert "iteration_limit" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [["knots", "--only", "nonsense"], ["primes", "--only", "unknot-20"]])
def test_unknown_curves(capsys, arguments):
    assert main(["bench", *arguments]) == 2
    assert "is unknown" in capsys.readouterr().err
