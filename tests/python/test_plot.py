"""Pictures and tables of records: the data for matplotlib and pandas, and notebook displays."""

from __future__ import annotations

import html
import re
import subprocess
import sys

import carom
import numpy as np
import pytest
from conftest import SOURCE

# A record without friction between the balls: the cue ball rolls into the 1 head-on.
HEAD_ON = dict(
    table={"cushion": []},
    balls={"mu_b": 0.0, "e_b": 1.0},
    ball=[{"id": "cue", "velocity": [0, 2.0], "position": [0, 0]}, {"id": "1", "position": [0, 0.5]}],
)


@pytest.fixture
def pyplot():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    yield pyplot
    pyplot.close("all")


def pixels(axes):
    """The picture as an array, and a function that returns the colour at a place on the table."""
    figure = axes.figure
    figure.canvas.draw()
    image = np.asarray(figure.canvas.buffer_rgba())[:, :, :3] / 255.0

    def at(x, y):
        column, row = axes.transData.transform((y, x))
        return image[image.shape[0] - 1 - int(row), int(column)]

    return image, at


def test_a_plan_has_balls_trails_and_pockets_in_place(pyplot):
    from carom.plot import _CLOTH, _HOLE
    from matplotlib.colors import to_rgb

    record = carom.simulate(carom.Scene(ball=[{"id": "red", "position": [0.4, 0.5]}],
                                        cue={"ball": "red", "speed": 1.5, "aim_deg": 90, "offset": [0, 0]}))
    red = record.colors[0]
    assert red.tolist() == pytest.approx([0.80, 0.06, 0.08])
    end = record.states(record.duration)[0, 0]
    image, at = pixels(carom.plot.table(record))
    near = dict(atol=0.06)
    np.testing.assert_allclose(at(end[0] + 0.015, end[1]), red, **near)
    np.testing.assert_allclose(at(0.4, 0.515), red, atol=0.35)  # the trail inside the starting ring
    np.testing.assert_allclose(at(0.4, 0.8), red, atol=0.35)
    np.testing.assert_allclose(at(0.42, 0.8), to_rgb(_CLOTH), **near)
    np.testing.assert_allclose(at(0.415, 0.5), to_rgb(_CLOTH), **near)  # the ring is empty
    for _, x, y, _radius in record.table.pockets:
        np.testing.assert_allclose(at(x, y), to_rgb(_HOLE), **near)
    # A given time draws a disc, where the trail ends; without trails there is none.
    place = record.states(0.3)[0, 0]
    _, at = pixels(carom.plot.table(record, at=0.3))
    np.testing.assert_allclose(at(place[0] + 0.015, place[1]), red, **near)
    np.testing.assert_allclose(at(0.4, place[1] + 0.1), to_rgb(_CLOTH), **near)
    _, at = pixels(carom.plot.table(record, trails=False))
    np.testing.assert_allclose(at(0.4, 0.8), to_rgb(_CLOTH), **near)


def test_a_plan_matches_other_pictures(pyplot, break_scene):
    record = carom.simulate(break_scene)
    axes = carom.plot.table(record)
    assert axes.yaxis_inverted() and axes.get_aspect() == 1.0
    down = {e.a for e in record.event_list() if e.type == "ball_pocket"}
    assert down and {text.get_text() for text in axes.texts} == set(record.ids) - down
    own = pyplot.figure().add_subplot()
    assert carom.plot.table(record, ax=own) is own
    with pytest.raises(ValueError, match="not a number"):
        carom.plot.table(record, at=np.nan)


def test_flights_are_dotted_and_an_endless_cloth_shows_its_balls(pyplot):
    jump = carom.simulate(carom.Scene.load(SOURCE / "scenes/jump.toml"))
    styles = [collection.get_linestyle()[0][1] for collection in carom.plot.table(jump).collections]
    flying = sum(jump.MOTIONS.index("airborne") in segments["state"] for segments in jump.segments)
    assert sum(dashes is not None for dashes in styles) == flying > 0
    record = carom.simulate(carom.Scene(**HEAD_ON))
    axes = carom.plot.table(record)
    places = record.states(np.linspace(0, record.duration, 50))[:, :, 0]
    for axis, (low, high) in ((1, axes.get_xlim()), (0, sorted(axes.get_ylim()))):
        assert low < places[..., axis].min() and places[..., axis].max() < high


def test_speeds_and_energies_match_the_states(pyplot):
    record = carom.simulate(carom.Scene(**HEAD_ON))
    hit = next(e.time for e in record.event_list() if e.type == "ball_ball")
    lines = {line.get_label(): line.get_xydata() for line in carom.plot.speeds(record).lines}
    assert set(lines) == {"cue", "1"}
    for ball, name in enumerate(record.ids):
        times, speed = lines[name].T
        np.testing.assert_allclose(
            speed, np.linalg.norm(record.states(times)[:, ball, 1], axis=-1), atol=1e-12)
        # Both sides of the impact, so that the jump is vertical.
        assert (times < hit).any() and np.diff(times[np.searchsorted(times, hit) - 1 :][:2])[0] < 1e-12
    energy = carom.plot.energy(record)
    assert [text.get_text() for text in energy.get_legend().get_texts()] == ["travel", "rotation"]
    first = max(polygon.get_paths()[0].vertices[:, 1].max() for polygon in energy.collections)
    assert first == pytest.approx(0.5 * record.masses[0] * 4.0, rel=1e-12)


def test_a_notebook_shows_the_page_without_outside_resources(pyplot):
    scene = carom.Scene(**HEAD_ON | {"ball": [{"id": "<b>", "velocity": [0, 2.0]}]})
    record = carom.simulate(scene, until=0.5)
    shown = record._repr_html_()
    assert "1 balls" in shown and not re.search(r"<b>|<script", shown)
    inside = re.fullmatch(r'<iframe [^>]* sandbox="allow-scripts" srcdoc="([^"]+)"></iframe>', shown)[1]
    assert html.unescape(inside) == record.page()
    assert not re.search(r"https?://(?!www.w3.org/2000/svg)", record.page())
    assert record.page(record).count('<script type="application/json"') == 3

    assert record._repr_png_().startswith(b"\x89PNG")
    assert pyplot.get_fignums() == []


def test_without_matplotlib_the_error_names_it():
    code = f"""
import sys
sys.modules["matplotlib"] = None
sys.modules["pandas"] = None
import carom
record = carom.simulate(carom.Scene.load({str(SOURCE / "scenes/draw.toml")!r}))
assert record._repr_png_() is None
for call in (carom.plot.table, carom.Record.to_pandas):
    try:
        call(record)
    except ImportError as error:
        print(error)
"""
    out = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.splitlines()
    assert out == [
        "carom.plot needs matplotlib: pip install matplotlib",
        "to_pandas needs pandas: pip install pandas",
    ]


def test_events_and_segments_become_data_frames(break_scene):
    pytest.importorskip("pandas")
    record = carom.simulate(break_scene)
    events = record.to_pandas()
    assert list(zip(events["time"], events["type"], events["a"], events["b"])) == record.event_list()
    assert (events["detail"] == record.events["detail"]).all()
    segments = record.to_pandas("segments")
    for ball, view in zip(record.ids, record.segments):
        rows = segments[segments["ball"] == ball]
        assert (rows["start"].to_numpy() == view["start"]).all()
        assert (rows["held"].to_numpy() == view["held"]).all()
        assert (rows[["rx", "ry", "rz"]].to_numpy() == view["r"]).all()
        assert (rows[["dwx", "dwy"]].to_numpy() == view["dw"]).all()
        assert list(rows["state"]) == [record.MOTIONS[state] for state in view["state"]]
    assert len(segments) == sum(map(len, record.segments))
    with pytest.raises(ValueError, match="expected events or segments"):
        record.to_pandas("balls")
