"""Sweeps: the same table as `carom sweep`, bit for bit."""

from __future__ import annotations

import carom
import numpy as np
import pytest
from carom import sweep
from conftest import SOURCE, program_sweep, refused

RULES = {
    "draw": ["cue.aim_deg=normal(2)", "cue.speed=uniform(-0.5,4)", "cue.offset.side=list(0.1,-0.1)"],
    "eight_ball_break": ["rack.seed=integer(1,9)", "cue.aim_deg=normal(0.3)"],
    "three_cushion": ['physics.cushion=list("smooth","stronge","none")', "cue.speed=list(3,4)"],
}


def same(text, value):
    """Whether a CSV cell equals the value bit for bit."""
    if value is None:
        return text == ""
    if isinstance(value, float):
        return text == "" if np.isnan(value) else float(text) == value
    return text == str(value)


def all_the_same(header, rows, columns):
    """Whether columns have the same values as the rows of a CSV file."""
    assert list(columns) == header
    for k, column in enumerate(header):
        wrong = [(row[k], value) for row,
                 value in zip(rows, columns[column], strict=True) if not same(row[k], value)]
        assert not wrong, (column, wrong[:3])


@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("threads", [1, 3])
def test_columns_match_the_program(tmp_path, name, threads):
    path, count = SOURCE / f"scenes/{name}.toml", 60
    rules = RULES[name]
    header, rows = program_sweep(tmp_path, path, rules, count, 4)
    scene = carom.Scene.load(path)
    columns = sweep.columns(scene, rules, count, seed=4, threads=threads)
    assert len(rows) == count
    all_the_same(header, rows, {name: values.tolist() if isinstance(values, np.ndarray) else values for name,
                                values in columns.items()})
    assert set(columns["status"]) >= {"at_rest"}
    part = sweep.columns(scene, rules, count, seed=4, first=20, last=45)
    for column, values in part.items():
        np.testing.assert_array_equal(values, columns[column][20:45])


def test_a_mapping_is_equivalent():
    scene = carom.Scene.load(SOURCE / "scenes/draw.toml")
    rules = ["cue.speed=list(2.0,2.5)", "cue.aim_deg=normal(1)"]
    one = sweep.columns(scene, rules, 10)
    two = sweep.columns(scene, {"cue.speed": [2.0, 2.5], "cue.aim_deg": "normal(1)"}, 10)
    for name in one:
        np.testing.assert_array_equal(one[name], two[name])
    assert one["cue.speed"].dtype == np.float64
    assert sweep.columns(scene, {"cue.speed": [2, 3]}, 5)["cue.speed"].dtype == np.int64
    other = sweep.columns(scene, ["cue.speed=list(0x2,2.5)", "cue.aim_deg=list(0o132,0b1011010)"], 9)
    assert set(other["cue.speed"]) == {2.0, 2.5} and set(other["cue.aim_deg"].tolist()) == {90}


def test_errors_are_explained(draw_scene):
    refused(
        ValueError,
        None,
        (lambda: sweep.columns(draw_scene, "cue.speed=uniform(2,4)", 5),
         "vary: expected a mapping or a list"),
        (lambda: sweep.columns(draw_scene, ["cue.speed=gauss(2)"], 5), "unknown distribution"),
        (lambda: sweep.columns(draw_scene, ["cue.speed=list(-1)"], 5), "none of the first"),
        (lambda: sweep.columns(draw_scene, {"cue.speed": [2.0]}, 5, last=6), "first=0, last=6"),
        (lambda: sweep.columns(draw_scene, {"cue.speed": [2.0]}, 5, threads=-1), "threads=-1"),
        (lambda: sweep.columns(draw_scene, {"cue.speed": [2.0]}, 5, seed=-1), "seed=-1"),
    )


def test_a_table_has_the_columns_and_their_origin(draw_scene, tmp_path):
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    rules = RULES["draw"]
    columns = sweep.columns(draw_scene, rules, 80, seed=2)
    table = sweep.table(draw_scene, rules, 80, seed=2)
    assert table.column_names == list(columns)
    assert set(table["status"].to_pylist()) == {"at_rest", "invalid"}
    for name, values in columns.items():
        values = values.tolist() if isinstance(values, np.ndarray) else values
        wanted = [None if isinstance(value, float) and np.isnan(value) else value for value in values]
        assert table[name].to_pylist() == wanted, name
    parquet.write_table(table, tmp_path / "t.parquet")
    again = parquet.read_table(tmp_path / "t.parquet")
    assert again.equals(table)
    about = {key.decode(): value.decode() for key, value in again.schema.metadata.items()}
    assert carom.Scene.loads(about["carom.scene"]) == draw_scene
    assert (about["carom.seed"], about["carom.first"], about["carom.last"], about["carom.version"]) == (
        "2", "0", "80", carom.__version__)
    assert pyarrow.types.is_int64(table.schema.field("events").type)
