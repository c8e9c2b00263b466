"""Pages from Python: reports, tosses in three dimensions, maps."""

import html
import json
import re

import pytest

import coinmc

SCENE = {
    "coin": {"ratio": [1.0, 2.0]},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "stop": {"tosses": 500},
}


def data(page: coinmc.Page) -> dict:
    found = re.search(r'id="data">(.*?)</script>', page.html, re.DOTALL)
    return json.loads(found[1])


def test_a_report_holds_results_in_memory_and_on_disk(tmp_path):
    result = coinmc.estimate(SCENE)
    stored = coinmc.run(SCENE, tmp_path / "a run")
    told = data(coinmc.report(result, stored, tmp_path / "a run", title="two"))
    assert told["title"] == "two"
    names = [run["name"] for run in told["runs"]]
    assert names == ["estimate 1", str(tmp_path / "a run"), str(tmp_path / "a run")]
    for run in told["runs"]:
        [sides] = [column for column in run["columns"] if column["name"] == "side"]
        assert sides["values"] == result["side"].tolist()
        assert run["samples"]


def test_tosses_of_several_configs_share_a_scene():
    surfaces = [{"surface.restitution": e} for e in (0.3, 0.7)]
    traces = [coinmc.trace(SCENE, 3, overrides=surface, rate_hz=0) for surface in surfaces]
    told = data(coinmc.replay(*traces))
    assert [toss["outcome"] for toss in told["tosses"]] == [trace.outcome for trace in traces]
    assert [toss["at"][-1] for toss in told["tosses"]] == [
        ["restitution", 0.3],
        ["restitution", 0.7],
    ]
    own = coinmc.launches(SCENE, 1, first=3)
    [toss] = data(coinmc.replay(coinmc.trace(SCENE, launch=own)))["tosses"]
    assert toss["outcome"] == coinmc.trace(SCENE, 3).outcome


def test_a_trace_shows_itself_in_notebooks():
    trace = coinmc.trace(SCENE, 3)
    frame = trace._repr_html_()
    inside = re.search(r'srcdoc="([^"]*)"', frame)[1]
    assert html.unescape(inside) == coinmc.replay(trace).html
    assert "sandbox=" in frame


def test_a_map_is_of_the_faces_that_tosses_show():
    faces = coinmc.plot.basin_faces(SCENE, "wy_rad_s", "height_m", (0, 30, 0.1, 0.6), shape=(3, 5))
    page = coinmc.basins(SCENE, "wy_rad_s", "height_m", (0, 30, 0.1, 0.6), shape=(3, 5))
    shown = [pixel["outcome"] for pixel in data(page)["map"]["pixels"]]
    assert shown == [coinmc.Face(face).name.lower() for face in faces.ravel()]


def test_only_pages_are_replaced(tmp_path):
    page = coinmc.replay(coinmc.trace(SCENE, 3))
    path = page.save(tmp_path / "a.html")
    with pytest.raises(FileExistsError):
        page.save(path)
    page.save(path, replace=True)
    path.write_text("notes")
    with pytest.raises(FileExistsError, match="no page of coinmc"):
        page.save(path, replace=True)
    assert path.read_text() == "notes"


def test_what_cannot_be_shown_is_told(tmp_path):
    with pytest.raises(ValueError, match="needs a run"):
        coinmc.report()
    with pytest.raises(coinmc.RunError, match="not a run directory"):
        coinmc.report(tmp_path)
    with pytest.raises(ValueError, match="1 to 24"):
        coinmc.replay()
    with pytest.raises(ValueError, match="no quantity `spin`"):
        coinmc.basins(SCENE, "spin", "height_m", (0, 1, 0, 1))
