"""Designed coins, read by an independent library."""

import json
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import trimesh

# Coins with a conical edge are tossed on planes only.
LEVEL = ["--set", "surface.roughness_slope=0"]
COINS = {
    "sharp": [],
    "rounded": ["--rim", "1mm"],
    "chamfered": ["--chamfer", "1mm", "--marks"],
    "of the config": ["--set", "coin.rim_radius_m=0.001"],
    "conical": ["--draft", "-12", *LEVEL],
    "conical by its config": ["--set", "coin.draft_deg=8", *LEVEL],
    "hollow": ["--rim", "0.5mm", "--marks", "--walls", "1mm", "--infill", "15"],
}


@pytest.fixture(scope="module", params=COINS)
def designed(request, coinmc, tmp_path_factory):
    """The document of a design, the folder of its files, and its name."""
    folder = tmp_path_factory.mktemp("designs")
    arguments = ["design", "--scene", "felt", "--half-width", "0.05", "--format", "json"]
    said = coinmc(*arguments, "--out", request.param, *COINS[request.param], cwd=folder)
    return json.loads(said.stdout), folder, request.param


@pytest.mark.parametrize("ending", ["stl", "3mf"])
def test_meshes_are_closed_and_have_the_volume_and_moments_of_the_coin(designed, ending):
    document, folder, name = designed
    mesh = trimesh.load(folder / f"{name}.{ending}", force="mesh")
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.is_volume
    assert mesh.euler_number == 2
    # files are in millimetres
    assert mesh.volume == pytest.approx(1e9 * document["volume_m3"], rel=1e-3)
    thickness = mesh.bounds[1] - mesh.bounds[0]
    assert thickness[2] == pytest.approx(1e3 * document["thickness_m"], rel=1e-5)
    moments = np.linalg.eigvalsh(mesh.moment_inertia)
    # the marks keep both transverse moments equal
    assert moments[0] == pytest.approx(moments[1], rel=1e-4) or moments[1] == pytest.approx(
        moments[2], rel=1e-4
    )
    if name != "hollow":
        per_mass = mesh.moment_inertia / mesh.volume * 1e-6
        mass = document["mass_kg"]
        assert per_mass[2, 2] == pytest.approx(document["axial_moment_kg_m2"] / mass, rel=1e-3)
        transverse = document["transverse_moment_kg_m2"] / mass
        assert per_mass[0, 0] == pytest.approx(transverse, rel=1e-3)


def test_a_conical_mesh_is_the_frustum_that_its_document_names(designed):
    """Radii and centre of mass; a test in Rust compares with the coin that the engine tosses."""
    document, folder, name = designed
    if "conical" not in name:
        assert document["faces"] is None
        assert document["centre_of_mass_m"] == 0
        return
    mesh = trimesh.load(folder / f"{name}.stl", force="mesh")
    height = 1e3 * document["thickness_m"]
    radius = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    heads, tails = (
        radius[np.isclose(mesh.vertices[:, 2], end * height / 2, atol=1e-4)].max()
        for end in (1, -1)
    )
    # heads is towards +z, and the wider face if the draft is above 0
    wide, narrow = (heads, tails) if document["draft_deg"] > 0 else (tails, heads)
    assert wide == pytest.approx(500 * document["diameter_m"], rel=1e-3)
    slope = np.tan(np.radians(abs(document["draft_deg"])))
    assert wide - narrow == pytest.approx(height * slope, rel=1e-3)
    # of a frustum, from its wider face: (H/4)(R² + 2Rb + 3b²)/(R² + Rb + b²)
    from_wide = height / 4 * (wide**2 + 2 * wide * narrow + 3 * narrow**2)
    from_wide /= wide**2 + wide * narrow + narrow**2
    expected = np.sign(document["draft_deg"]) * (height / 2 - from_wide)
    assert mesh.center_mass[2] == pytest.approx(expected, rel=1e-3)
    assert 1e3 * document["centre_of_mass_m"] == pytest.approx(expected, rel=1e-3)
    faces = document["faces"]
    assert faces["heads"]["p"] + faces["tails"]["p"] == pytest.approx(2 / 3, abs=0.03)
    # it comes to lie on its wider face more often, which shows the narrower one
    shown = ["tails", "heads"] if document["draft_deg"] > 0 else ["heads", "tails"]
    assert faces[shown[0]]["lo"] > faces[shown[1]]["hi"]


def test_a_sheet_is_one_page_of_svg(designed):
    document, folder, name = designed
    sheet = ElementTree.parse(folder / f"{name}.svg").getroot()
    assert sheet.get("width") == "210mm"
    assert sheet.get("height") == "297mm"
    words = [text.text for text in sheet.iter("{http://www.w3.org/2000/svg}text")]
    assert any(f"thickness {1e3 * document['thickness_m']:.2f}" in line for line in words)
    # nothing below the page
    ys = [float(text.get("y")) for text in sheet.iter("{http://www.w3.org/2000/svg}text")]
    assert max(ys) < 290
    assert document["tolerances"][1]["tosses_to_tell"] > 1000


def test_a_hollow_coin_is_lighter_and_harder_to_turn_for_its_mass(coinmc, tmp_path):
    common = ["design", "--scene", "felt", "--half-width", "0.05", "--format", "json"]
    hollow = ["--walls", "1mm", "--infill", "0"]
    full, light = (
        json.loads(coinmc(*common, "--out", name, *extra, cwd=tmp_path).stdout)
        for name, extra in (("full", []), ("light", hollow))
    )
    assert light["mass_kg"] < 0.6 * full["mass_kg"]

    def gyration(document):
        moment = document["axial_moment_kg_m2"] / document["mass_kg"]
        return moment / (0.25 * document["diameter_m"] ** 2)

    assert gyration(full) == pytest.approx(0.5, rel=1e-9)
    assert gyration(light) > 0.55


def test_nothing_is_overwritten(coinmc, tmp_path):
    (tmp_path / "mine.3mf").write_text("precious")
    said = coinmc("design", "--scene", "felt", "--out", "mine", cwd=tmp_path, check=False)
    assert said.returncode == 2
    assert "mine.3mf exists already" in said.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["mine.3mf"]
    assert (tmp_path / "mine.3mf").read_text() == "precious"
