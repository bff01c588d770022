"""``mobius-flow bench``: a row per curve, and an exit status that tells whether all is well."""

import json

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


def test_speed_prints_three_tables(capsys):
    assert main(["bench", "speed", "--sizes", "60, 80", "--solver", "hierarchical"]) == 0
    times, products, copies = capsys.readouterr().out.split("\nthe same in ")
    for table, last in ((times, "MB"), (products, "iteration"), (copies, "iteration")):
        _, header, *rows = table.splitlines()
        assert header.split()[:3] == ["vertices", "solver", "lists"]
        assert header.split()[-1] == last
        assert [row.split()[:2] for row in rows[:2]] == [["60", "hierarchical"], ["80", "hierarchical"]]
        assert all(len(row) == len(header) for row in rows[:2])
    assert "80 vertices, against dense: energy " in copies


def test_speed_as_json(capsys):
    assert main(["bench", "speed", "--sizes", "60", "--json", "--accuracy", "1e-3"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert {"machine", "rows", "exponents", "options", "version", "blas_threads", "numpy", "scipy"} <= set(report)
    assert report["options"]["accuracy"] == 1e-3
    assert report["options"]["mesh"] == "fixed"
    (row,) = report["rows"]
    assert (row["vertices"], row["solver"], row["deviation"]) == (60, "dense", None)
    assert row["peak_bytes"] > 0
    for name, seconds in row["seconds"].items():
        assert row["in_products"][name] == seconds / report["machine"]["product"]
        assert row["in_copies"][name] == seconds / report["machine"]["copy"]


@pytest.mark.parametrize("sizes", ["", "200,", "2e2", "-200", "٣٠٠", "9" * 5000, "200;300", "20", "300000", "200,200"])
def test_bad_sizes_are_one_sentence(capsys, sizes):
    assert main(["bench", "speed", f"--sizes={sizes}"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert "sizes has " in error
    assert len(error) < 200


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["speed", "--only", "3_1"], "give --sizes"),
        (["speed", "--vertices", "300"], "give sizes"),
        (["knots", "--sizes", "200"], "leave them out of bench knots"),
        (["primes", "--json"], "leave them out of bench primes"),
    ],
)
def test_options_of_the_other_kind_of_bench(capsys, arguments, expected):
    assert main(["bench", *arguments]) == 2
    assert expected in capsys.readouterr().err
