"""`coinmc show --format ro-crate`, judged by two packages that know RO-Crate and not coinmc."""

import io
import json
import shutil
from pathlib import Path

import pytest
from test_results import CLOSED, CONFIG

rocrate = pytest.importorskip("rocrate.rocrate", reason="pip install rocrate")
pytest.importorskip("rocrate_validator", reason="pip install roc-validator")
requests = pytest.importorskip("requests")
urllib3 = pytest.importorskip("urllib3")


@pytest.fixture(scope="module")
def crate(coinmc, tmp_path_factory):
    """A run merged from two parts, described in its directory."""
    folder = tmp_path_factory.mktemp("crate")
    (folder / "toss.toml").write_text(CONFIG)
    for part in "12":
        coinmc("run", "toss.toml", "--shard", f"{part}/2", "--out", part, "--quiet", cwd=folder)
    coinmc("merge", "1", "2", "--out", "merged", cwd=folder)
    shown = coinmc("show", "merged", "--format", "ro-crate", cwd=folder)
    (folder / "merged" / "ro-crate-metadata.json").write_text(shown.stdout)
    return folder / "merged"


def test_the_crate_names_every_file_and_what_made_it(coinmc, crate):
    read = rocrate.ROCrate(crate)
    files = {entity.id for entity in read.data_entities if entity.type == "File"}
    there = {path.name for path in crate.iterdir()}
    assert files == there - {"lock", "ro-crate-metadata.json"}
    for name in files:
        assert int(read.get(name)["contentSize"]) == (crate / name).stat().st_size
    manifest = json.loads((crate / "manifest.json").read_text())
    [software] = read.get_by_type("SoftwareApplication")
    assert [software["softwareVersion"]] == manifest["builds"]
    [action] = read.get_by_type("CreateAction")
    assert action["instrument"] is software
    assert action["object"].id == "config.toml"
    assert {entity.id for entity in action["result"]} == files - {"config.toml", "manifest.json"}
    used = {entity["name"]: entity["value"] for entity in action["resourceUsage"]}
    assert used["tosses"] == 60_000
    assert used["chunks"] == 6
    assert 0 < used["wall time"] < 60
    shown = json.loads(coinmc("show", crate, "--format", "json").stdout)
    [made] = shown["made_by"]
    assert (made["chunks"], made["wall_s"], shown["unrecorded_chunks"]) == (6, used["wall time"], 0)


@pytest.fixture
def no_network(monkeypatch, tmp_path):
    """The vocabulary of RO-Crate from the package `rocrate` instead of from the network."""
    vocabulary = (Path(rocrate.__file__).parent / "data" / "ro-crate.jsonld").read_bytes()

    def send(_, request, **__):
        assert request.url == "https://w3id.org/ro/crate/1.1/context"
        answer = requests.Response()
        answer.status_code, answer.url, answer.request = 200, request.url, request
        answer.headers["Content-Type"] = "application/ld+json"
        answer.raw = urllib3.HTTPResponse(io.BytesIO(vocabulary), preload_content=False)
        return answer

    monkeypatch.setattr(requests.adapters.HTTPAdapter, "send", send)
    return {"cache_path": tmp_path / "cache"}


def problems(crate, no_network):
    """What the profile, and RO-Crate 1.1, on which it stands, ask for and do not find."""
    from rocrate_validator import models, services

    settings = services.ValidationSettings(
        rocrate_uri=crate,
        profile_identifier="process-run-crate",
        requirement_severity=models.Severity.REQUIRED,
        **no_network,
    )
    result = services.validate(settings)
    return [f"{issue.check.identifier}: {issue.message}" for issue in result.get_issues()]


def test_the_crate_is_valid(crate, no_network, tmp_path):
    assert problems(crate, no_network) == []
    # and the judge does judge
    broken = tmp_path / "broken"
    shutil.copytree(crate, broken)
    metadata = broken / "ro-crate-metadata.json"
    metadata.write_text(metadata.read_text().replace('"instrument"', '"datePublished"'))
    (broken / "results.csv").unlink()
    assert len(problems(broken, no_network)) >= 2


def test_a_run_without_tosses_is_a_crate_too(coinmc, tmp_path):
    (tmp_path / "arc.toml").write_text(CLOSED)
    coinmc("run", "arc.toml", "--out", "out", cwd=tmp_path)
    shown = json.loads(coinmc("show", "out", "--format", "ro-crate", cwd=tmp_path).stdout)
    ids = [entity["@id"] for entity in shown["@graph"]]
    assert len(ids) == len(set(ids))
    assert "tallies.txt" not in ids
