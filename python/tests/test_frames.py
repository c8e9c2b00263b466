"""Tosses, traces and sensitivities are tables to other libraries."""

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa

import coinmc


def same(table, columns):
    frame = pl.DataFrame(table)
    assert frame.columns == list(columns)
    for name, column in columns.items():
        assert frame[name].to_list() == column.tolist(), name
    assert pa.table(table).column_names == list(columns)
    assert isinstance(table.to_pandas(), pd.DataFrame)
    assert table.to_polars().equals(frame)


def test_tosses(scene):
    tosses = coinmc.toss(scene, 500, first=20)
    columns = tosses.columns
    assert columns["toss"].tolist() == list(range(20, 520))
    assert columns["face"].tolist() == [coinmc.Face(face).name.lower() for face in tosses.face]
    assert columns["spin_y_rad_s"].tolist() == tosses.final["spin_rad_s"][:, 1].tolist()
    assert columns["position_z_m"].tolist() == tosses.final["position_m"][:, 2].tolist()
    assert columns["axis_x"].tolist() == tosses.final["axis"][:, 0].tolist()
    same(tosses, columns)


def test_a_trace(scene):
    trace = coinmc.trace(scene, 3)
    assert trace.columns["quaternion_w"].tolist() == trace.samples["quaternion"][:, 0].tolist()
    same(trace, trace.columns)


def test_sensitivities(scene):
    table = coinmc.sensitivity(scene, ["coin.ratio", "surface.friction"], tosses=2000)
    same(table, table.columns)
    assert np.isfinite(table["gain_side"]).all()
