"""Every JSON document that the program prints is described."""

import re

KIND = re.compile(r'"kind": "([\w-]+)"')


def test_every_kind_of_document_is_described(root):
    """Every kind in the sources has a row, but for those within a document of another kind."""
    sources = [*root.glob("crates/*/src/**/*.rs")]
    printed = {kind for source in sources for kind in KIND.findall(source.read_text())}
    formats = (root / "docs/reference/formats.md").read_text()
    rows = re.findall(r"^\| (`[^|]*) \|", formats, re.MULTILINE)
    described = {kind for row in rows for kind in re.findall(r"`([\w-]+)`", row)}
    # of a measurement within a calibration, docs/reference/calibrate.md
    assert {"run", "robot-run"} <= printed
    assert printed - described == {"counts"}
