"""Reading photos that may be anything: what they are is known before they are decoded."""

import os
import warnings
from pathlib import Path

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._files import open_plain
from coinmc.vision._needs import pillow

__all__ = ["read_photo"]

#: Largest file, bytes, and largest photo, pixels.
MOST_BYTES = 64 << 20
MOST_PIXELS = 50_000_000
#: Smallest edge, pixels.
LEAST_EDGE = 16
# (a phone's JPEG with two pictures, MPO, is opened as a JPEG: the first is read)
_KINDS = ("JPEG", "PNG")


def read_photo(path: Path | str, size: tuple[int, int] | None = None) -> np.ndarray:
    """Read a photo as grey values.

    Pixels stay as the sensor saw them: a turn that the file asks for (EXIF) is not made, because
    the calibration is that of the sensor. 16-bit photos are read as 8-bit ones.

    Parameters
    ----------
    path : path
        A JPEG or PNG file.
    size : tuple of int, optional
        The width and height that it must have.

    Returns
    -------
    ndarray of uint8, shape (height, width)

    Raises
    ------
    coinmc.VisionError
        If it is no photo, damaged, animated, too large, or of another size.
    """
    image_of = pillow()
    try:
        with open_plain(path) as file, warnings.catch_warnings():
            if os.fstat(file.fileno()).st_size > MOST_BYTES:
                raise VisionError(f"{path} is larger than {MOST_BYTES >> 20} MiB")
            # Pillow's own warning of large photos: they are refused below
            warnings.simplefilter("ignore")
            with image_of.open(file, formats=_KINDS) as image:
                _check(image, str(path), size)
                return _grey(image)
    except VisionError:
        raise
    except image_of.UnidentifiedImageError:
        raise VisionError(f"{path} is not a JPEG or PNG photo") from None
    except image_of.DecompressionBombError:
        raise VisionError(_too_large(str(path))) from None
    except OSError as error:
        raise VisionError(f"{path} cannot be read: {error.strerror or error}") from error
    # what decoders raise at damaged files is not fixed
    except (SyntaxError, ValueError, EOFError, ArithmeticError, LookupError, TypeError) as error:
        raise VisionError(f"{path} is damaged: {error}") from error


def _too_large(name: str) -> str:
    return f"{name} has more than {MOST_PIXELS // 10**6} million pixels"


def _check(image, name: str, size: tuple[int, int] | None) -> None:
    width, height = image.size
    if width * height > MOST_PIXELS:
        raise VisionError(_too_large(name))
    if image.format != "MPO" and getattr(image, "is_animated", False):
        raise VisionError(f"{name} is animated: give a photo")
    if min(width, height) < LEAST_EDGE:
        raise VisionError(f"{name} is only {width} x {height} pixels")
    if size and (width, height) != size:
        raise VisionError(
            f"{name} is {width} x {height} pixels, but the camera was calibrated for "
            f"{size[0]} x {size[1]}"
        )


def _grey(image) -> np.ndarray:
    if image.mode.startswith("I") or image.mode == "F":
        deep = np.asarray(image)
        return (np.clip(deep, 0, 65_535).astype(np.uint32) >> 8).astype(np.uint8)
    if image.mode in ("RGBA", "LA", "PA", "P"):
        image = image.convert("RGB")
    return np.array(image.convert("L"))
