"""``python -m coinmc.vision``: sheets to print, calibration, reading photos, a camera to serve."""

import argparse
import json
import os
import sys
from pathlib import Path

from coinmc._errors import Error, VisionError

__all__ = ["main"]


def main(words: list[str] | None = None) -> int:
    """Run a command; return its exit status: 0, 1 without a needed library, 2 for bad input."""
    given = _parser().parse_args(words)
    try:
        return given.command(given)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        # the host has gone; nothing more can be written, not even at the end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m coinmc.vision", description=__doc__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    sheet = commands.add_parser("sheet", help="markers and a board to print, and the coin's file")
    sheet.add_argument("--radius-mm", type=float, required=True)
    sheet.add_argument("--ratio", type=float, required=True, help="height over radius")
    sheet.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="default: here")
    sheet.set_defaults(command=_sheet)

    calibrate = commands.add_parser("calibrate", help="a camera, from photos of the board")
    calibrate.add_argument("photos", nargs="+", type=Path, metavar="PHOTO")
    calibrate.add_argument(
        "--table",
        type=Path,
        required=True,
        metavar="PHOTO",
        help="the board flat on the table, the camera in its place",
    )
    calibrate.add_argument("--square-mm", type=float, help="edge of a square, as measured")
    calibrate.add_argument("--out", type=Path, required=True, metavar="FILE")
    calibrate.set_defaults(command=_calibrate)

    classify = commands.add_parser("classify", help="read photos: one line of JSON for each")
    classify.add_argument("photos", nargs="+", type=Path, metavar="PHOTO")
    _coin_and_calibration(classify)
    classify.set_defaults(command=_classify)

    serve = commands.add_parser("serve", help="be the camera of `coinmc robot`")
    serve.add_argument(
        "--camera",
        required=True,
        metavar="0|FILE|synthetic",
        help="a camera's number, a photo that another program renews, or rendered photos",
    )
    _coin_and_calibration(serve)
    serve.add_argument(
        "--truth", type=Path, metavar="FILE", help="of `coinmc robot sim`, for rendered photos"
    )
    serve.add_argument(
        "--hard",
        type=_share,
        default=0.0,
        metavar="SHARE",
        help="share of rendered photos that are bad",
    )
    serve.add_argument(
        "--moving",
        type=_share,
        default=0.0,
        metavar="SHARE",
        help="share of rendered photos in which the coin still moves",
    )
    serve.add_argument("--seed", type=_seed, default=1)
    serve.set_defaults(command=_serve)

    synthetic = commands.add_parser("synthetic", help="render photos, of the coin or of the board")
    synthetic.add_argument("--coin", type=Path, required=True, metavar="FILE")
    synthetic.add_argument("--photos", type=int, default=12)
    synthetic.add_argument("--board", action="store_true", help="of the board, for `calibrate`")
    synthetic.add_argument("--hard", action="store_true", help="bad photos, and traps")
    synthetic.add_argument("--seed", type=_seed, default=1)
    synthetic.add_argument("--out", type=Path, required=True, metavar="DIR")
    synthetic.set_defaults(command=_synthetic)
    return parser


def _coin_and_calibration(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--coin",
        type=Path,
        default=Path("coin.json"),
        metavar="FILE",
        help="the coin's file, of `sheet` (default: coin.json)",
    )
    parser.add_argument(
        "--calibration",
        type=Path,
        metavar="FILE",
        help="the camera's file, of `calibrate` (default: camera.json; any camera for rendered "
        "photos)",
    )


def _share(text: str) -> float:
    share = float(text)
    if not 0.0 <= share <= 1.0:
        raise argparse.ArgumentTypeError("a share is from 0 to 1")
    return share


def _seed(text: str) -> int:
    seed = int(text)
    if not 0 <= seed < 1 << 32:
        raise argparse.ArgumentTypeError("a seed is from 0 to 4294967295")
    return seed


def _sheet(given: argparse.Namespace) -> int:
    from coinmc.vision._coin import MarkedCoin
    from coinmc.vision._sheet import print_sheets, remarks

    coin = MarkedCoin.of(given.radius_mm, given.ratio)
    for path in print_sheets(coin, given.out):
        print(path)
    for remark in remarks(coin):
        print(f"coinmc: {remark}", file=sys.stderr)
    return 0


def _calibrate(given: argparse.Namespace) -> int:
    from coinmc.vision._board import Board
    from coinmc.vision._calibrate import calibrate

    board = Board()
    if given.square_mm is not None:
        if not 1.0 <= given.square_mm <= 200.0:
            raise VisionError("the edge of a square must be from 1 to 200 mm")
        board = board.scaled(given.square_mm)
    if given.out.exists():
        raise VisionError(f"{given.out} exists: give a new name")
    camera = calibrate(given.photos, given.table, board)
    camera.save(given.out)
    print(
        f"{given.out}: error {camera.rms_px:.2f} px, camera {camera.centre_mm[2]:.0f} mm above "
        "the table"
    )
    if camera.rms_px > 1.0:
        print("coinmc: more than 1 px: is the board flat, are the photos sharp?", file=sys.stderr)
    return 0


def _classifier(given: argparse.Namespace):
    from coinmc.vision._camera import Camera
    from coinmc.vision._classify import Classifier
    from coinmc.vision._coin import MarkedCoin

    coin = MarkedCoin.load(given.coin)
    return Classifier(coin, Camera.load(given.calibration or "camera.json"))


def _any_camera(given: argparse.Namespace):
    import numpy as np

    from coinmc.vision._classify import Classifier
    from coinmc.vision._coin import MarkedCoin
    from coinmc.vision.synthetic import drawn_camera

    coin = MarkedCoin.load(given.coin)
    return Classifier(coin, drawn_camera(coin.radius_mm, np.random.default_rng(given.seed)))


def _classify(given: argparse.Namespace) -> int:
    classifier = _classifier(given)
    status = 0
    for photo in given.photos:
        try:
            reading = {"photo": str(photo), **classifier.read(photo).document()}
        except VisionError as error:
            print(f"error: {error}", file=sys.stderr)
            status = 2
        else:
            print(json.dumps(reading), flush=True)
    return status


def _serve(given: argparse.Namespace) -> int:
    from coinmc.vision._serve import serve
    from coinmc.vision._sources import DeviceSource, FileSource, SyntheticSource

    if given.camera == "synthetic" and given.truth is None:
        raise VisionError("rendered photos need --truth, the file of `coinmc robot sim`")
    if given.camera == "synthetic" and given.calibration is None:
        classifier = _any_camera(given)
    else:
        classifier = _classifier(given)
    if given.camera == "synthetic":
        source = SyntheticSource(
            classifier.coin, classifier.camera, given.truth, given.seed, given.hard, given.moving
        )
    elif given.camera.isdigit():
        source = DeviceSource(int(given.camera), classifier.camera.size)
    else:
        source = FileSource(Path(given.camera))
    serve(source, classifier, sys.stdin, sys.stdout)
    return 0


def _synthetic(given: argparse.Namespace) -> int:
    from coinmc.vision._coin import MarkedCoin
    from coinmc.vision.synthetic._sets import board_set, coin_set

    coin = MarkedCoin.load(given.coin)
    if not 1 <= given.photos <= 100_000:
        raise VisionError("the number of photos must be from 1 to 100000")
    render = board_set if given.board else coin_set
    render(coin, given.out, given.photos, given.seed, given.hard)
    print(f"{given.out}: {given.photos} photos")
    return 0


if __name__ == "__main__":
    sys.exit(main())
