"""Shear frames that pound on each other, or on a wall, while the ground moves."""

from lumped.pounding.frames import Gap as Gap
from lumped.pounding.frames import PoundingFrames as PoundingFrames
from lumped.pounding.frames import ShearFrame as ShearFrame
from lumped.pounding.ground import STILL as STILL
from lumped.pounding.ground import GroundRecord as GroundRecord
from lumped.pounding.ground import Sine as Sine
from lumped.pounding.simulation import simulate as simulate
