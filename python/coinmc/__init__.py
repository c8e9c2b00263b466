"""How likely is a tossed cylinder to come to rest on heads, on tails or on its side?

The engines of coinmc at native speed, with NumPy arrays in and out:

* `toss`, `launches`: individual tosses, with launches drawn at random or your own;
* `estimate`: probabilities with intervals, in memory; `run`, `open`: in a run directory, also on
  other processes and clusters (`chunk`); `merge`: of parts;
* `trace`: the recorded motion of one toss; `replay`: tosses in three dimensions;
* `report`: a page of runs that opens anywhere;
* `ask`: a coin of the size of a euro on a usual surface, without a toss;
* `fair`: how thick is a fair coin, here or in everyday `scenes`?
* `sensitivity`: how strongly probabilities depend on parameters; `converge`: on tolerances;
* `calibrate`, `listen`: your table from measurements and recordings;
* `validate`: claims and public data sets, each with its verdict;
* `check`, `Config`: what a config means;
* `coinmc.analytic`: closed forms; `coinmc.film`: drops on film; `coinmc.plot`: plots;
* `coinmc.vision`: photos of real coins; `coinmc.experiment`: a robot's throws.

All quantities are in SI units, and names carry their unit. *Ratio* always means H/R, height over
**radius**. z points up, the surface is z = 0, and *heads* means that heads shows. The guide is
docs/guide/python.md.

Examples
--------
>>> import coinmc
>>> result = coinmc.estimate({
...     "coin": {"ratio": {"from": 0.8, "to": 1.8, "steps": 6}},
...     "surface": {"restitution": 0.5, "friction": 0.3},
...     "launch": {"preset": "robot"},
...     "engine": {"flat": {}},
... }, tosses=20_000)
>>> [fair] = result.fair()
>>> 1.6 < fair.lo < fair.value < fair.hi < 1.75
True
"""

import importlib
from typing import TYPE_CHECKING, Any

from coinmc import _lib, analytic
from coinmc._codes import Ended, Face
from coinmc._config import Config, ConfigLike, Group, Scene, Stop, check
from coinmc._errors import ConfigError, Error, FilmError, Problem, RunError, TraceError, VisionError
from coinmc._intervals import Estimate
from coinmc._launches import LAUNCH, STATE, launches
from coinmc._lib import __build__, __version__
from coinmc._results import Crossing, Result, estimate, open, run
from coinmc._tosses import Tosses, toss
from coinmc._trace import EVENT, SAMPLE, Trace, trace

if TYPE_CHECKING:
    from coinmc import experiment, film, plot, vision
    from coinmc._aim import Aimed, AimedLaunch, aim
    from coinmc._ask import Asked, ask
    from coinmc._calibrate import Calibration, CalibrationModel, calibrate
    from coinmc._compare import Comparison, compare
    from coinmc._converge import Convergence, converge
    from coinmc._design import Design, design
    from coinmc._executors import chunk
    from coinmc._fair import Fair, FairRoot, fair
    from coinmc._listen import Listened, listen
    from coinmc._merge import merge
    from coinmc._pages import Page, basins, replay, report
    from coinmc._ranking import Ranking, rank
    from coinmc._rare import Rare, rare
    from coinmc._sensitivity import Sensitivity, sensitivity
    from coinmc._validate import Validation, validate

__all__ = [
    "EVENT",
    "LAUNCH",
    "SAMPLE",
    "STATE",
    "Aimed",
    "AimedLaunch",
    "Asked",
    "Calibration",
    "CalibrationModel",
    "Comparison",
    "Config",
    "ConfigError",
    "ConfigLike",
    "Convergence",
    "Crossing",
    "Design",
    "Ended",
    "Error",
    "Estimate",
    "Face",
    "Fair",
    "FairRoot",
    "FilmError",
    "Group",
    "Listened",
    "Page",
    "Problem",
    "Ranking",
    "Rare",
    "Result",
    "RunError",
    "Scene",
    "Sensitivity",
    "Stop",
    "Tosses",
    "Trace",
    "TraceError",
    "Validation",
    "VisionError",
    "__build__",
    "__version__",
    "aim",
    "analytic",
    "ask",
    "basins",
    "calibrate",
    "check",
    "chunk",
    "compare",
    "converge",
    "design",
    "estimate",
    "experiment",
    "fair",
    "film",
    "launches",
    "listen",
    "merge",
    "open",
    "plot",
    "rank",
    "rare",
    "replay",
    "report",
    "run",
    "scenes",
    "sensitivity",
    "toss",
    "trace",
    "validate",
    "vision",
]

#: Imported on first use, to keep `import coinmc` fast.
_LAZY = {
    "experiment": "coinmc.experiment",
    "film": "coinmc.film",
    "plot": "coinmc.plot",
    "vision": "coinmc.vision",
    "Aimed": "coinmc._aim",
    "AimedLaunch": "coinmc._aim",
    "aim": "coinmc._aim",
    "Asked": "coinmc._ask",
    "ask": "coinmc._ask",
    "Calibration": "coinmc._calibrate",
    "CalibrationModel": "coinmc._calibrate",
    "calibrate": "coinmc._calibrate",
    "Comparison": "coinmc._compare",
    "compare": "coinmc._compare",
    "Convergence": "coinmc._converge",
    "converge": "coinmc._converge",
    "chunk": "coinmc._executors",
    "Design": "coinmc._design",
    "design": "coinmc._design",
    "Fair": "coinmc._fair",
    "FairRoot": "coinmc._fair",
    "fair": "coinmc._fair",
    "Listened": "coinmc._listen",
    "listen": "coinmc._listen",
    "Page": "coinmc._pages",
    "basins": "coinmc._pages",
    "replay": "coinmc._pages",
    "report": "coinmc._pages",
    "merge": "coinmc._merge",
    "Ranking": "coinmc._ranking",
    "rank": "coinmc._ranking",
    "Rare": "coinmc._rare",
    "rare": "coinmc._rare",
    "Sensitivity": "coinmc._sensitivity",
    "sensitivity": "coinmc._sensitivity",
    "Validation": "coinmc._validate",
    "validate": "coinmc._validate",
}


def scenes() -> dict[str, str]:
    """Return the everyday scenes of `fair`: what each is, by its name.

    Examples
    --------
    >>> import coinmc
    >>> coinmc.scenes()["wood"]
    'a finished table top of solid wood'
    """
    return dict(_lib.scenes())


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module 'coinmc' has no attribute {name!r}")
    module = importlib.import_module(_LAZY[name])
    return module if module.__name__ == f"coinmc.{name}" else getattr(module, name)


def __dir__() -> list[str]:
    return sorted(__all__)
