"""The libraries of the extra ``coinmc[vision]``, or a message that names it."""

import importlib
from types import ModuleType

__all__ = ["cv2", "matplotlib", "pillow"]


def _wanted(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"coinmc.vision needs {name.partition('.')[0]}, which is not installed: "
            'pip install "coinmc[vision]"'
        ) from error


def cv2() -> ModuleType:
    """Return OpenCV."""
    return _wanted("cv2")


def pillow() -> ModuleType:
    """Return Pillow's Image."""
    return _wanted("PIL.Image")


def matplotlib(name: str) -> ModuleType:
    """Return matplotlib, or a module of it."""
    return _wanted(f"matplotlib.{name}".rstrip("."))
