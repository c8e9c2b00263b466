"""A day of real tosses: the throws of a robot's journal, and what they say about a model.

`open` reads the directory of ``coinmc robot run``, also while the robot throws. Throws without a
result are never left out: they widen what can be said. The guide is
docs/guide/robot.md#a-day-analysed.
"""

from coinmc.experiment._day import Day, open
from coinmc.experiment._misread import Confusion, Corrected
from coinmc.experiment._model import LogLikelihood, Prediction

__all__ = ["Confusion", "Corrected", "Day", "LogLikelihood", "Prediction", "open"]
