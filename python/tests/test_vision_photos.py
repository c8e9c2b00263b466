"""Photos that are none, and photos of every kind."""

import io
import os
import struct
import tracemalloc
import zlib

import numpy as np
import pytest
from PIL import Image

import coinmc
from coinmc.vision import read_photo

GREY = np.random.default_rng(0).integers(0, 255, (48, 64), dtype=np.uint8)


def encoded(picture: Image.Image, kind: str, **more) -> bytes:
    """A file of a picture."""
    file = io.BytesIO()
    picture.save(file, kind, **more)
    return file.getvalue()


def png(width: int, height: int) -> bytes:
    """A PNG file that says it is this large."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        crc = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + crc

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    parts = [(b"IHDR", header), (b"IDAT", zlib.compress(b"\0" * 9000)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)


def turned() -> bytes:
    """A photo that asks to be shown turned by 90 degrees."""
    exif = Image.Exif()
    exif[0x0112] = 6
    return encoded(Image.fromarray(GREY), "JPEG", exif=exif)


PICTURE = Image.fromarray(GREY)
JPEG, PNG = encoded(PICTURE, "JPEG"), encoded(PICTURE, "PNG")


@pytest.mark.parametrize(
    ("content", "exact"),
    [
        (PNG, True),
        (JPEG, False),
        (encoded(PICTURE.convert("RGB"), "PNG"), True),
        (encoded(PICTURE.convert("RGBA"), "PNG"), True),
        (encoded(PICTURE.convert("CMYK"), "JPEG"), False),
        (encoded(Image.fromarray(GREY.astype(np.uint16) * 257), "PNG"), True),
        (turned(), False),
        (encoded(PICTURE, "MPO", save_all=True, append_images=[PICTURE]), False),
    ],
    ids=["png", "jpeg", "rgb", "rgba", "cmyk", "16-bit", "turned", "two-pictures"],
)
def test_photos_of_every_kind_are_read_as_the_sensor_saw_them(tmp_path, content, exact):
    (tmp_path / "photo").write_bytes(content)
    read = read_photo(tmp_path / "photo", (64, 48))
    assert (read.shape, read.dtype) == ((48, 64), np.uint8)
    off = np.abs(read.astype(int) - GREY)
    # JPEG blurs noise, and a turned photo would have nothing in common with it
    assert off.max() == 0 if exact else np.mean(off) < 12


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "not a JPEG or PNG"),
        (b"hello", "not a JPEG or PNG"),
        (JPEG[:300], "cannot be read"),
        (JPEG[:-200], "truncated"),
        (PNG[:200], "truncated"),
        (PNG[:-30], "truncated"),
        (PNG[:60] + b"\xff\xff" + PNG[62:], "cannot be read"),
        (encoded(PICTURE, "GIF"), "not a JPEG or PNG"),
        (encoded(PICTURE, "GIF", save_all=True, append_images=[PICTURE]), "not a JPEG or PNG"),
        (
            encoded(PICTURE, "PNG", save_all=True, append_images=[PICTURE.rotate(90)]),
            "animated",
        ),
        (encoded(PICTURE, "TIFF"), "not a JPEG or PNG"),
        (encoded(Image.new("L", (1, 1)), "PNG"), "only 1 x 1"),
        (png(100_000, 100_000), "more than 50 million pixels"),
        (png(10_000, 6_000), "more than 50 million pixels"),
        (png(2**31 - 1, 2**31 - 1), "more than 50 million pixels"),
        (png(0, 0), "not a JPEG or PNG"),
        (encoded(PICTURE.resize((128, 96)), "PNG"), "128 x 96 pixels, but the camera"),
    ],
)
def test_what_is_no_photo_is_refused_before_it_takes_memory(tmp_path, content, told):
    (tmp_path / "photo").write_bytes(content)
    tracemalloc.start()
    with pytest.raises(coinmc.VisionError, match=told):
        read_photo(tmp_path / "photo", (64, 48))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 << 20


def test_folders_and_endless_files_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe.jpg")
    for path in (tmp_path, tmp_path / "missing", "/dev/zero", tmp_path / "pipe.jpg"):
        with pytest.raises(coinmc.VisionError):
            read_photo(path)


def test_damaged_files_never_raise_anything_else(tmp_path):
    rng = np.random.default_rng(1)
    path, refused = tmp_path / "photo", 0
    for number in range(400):
        content = bytearray((JPEG, PNG)[number % 2])
        for _ in range(rng.integers(1, 6)):
            content[rng.integers(len(content))] = rng.integers(256)
        path.write_bytes(bytes(content[: rng.integers(len(content) + 1)]))
        try:
            read_photo(path)
        except coinmc.VisionError:
            refused += 1
    assert refused > 300
