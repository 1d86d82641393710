"""The engines, one a file. To add one: a class as in base.py, and its module's name here."""

import importlib

from .base import Absent, Engine, Program

_modules = ("bullet", "pybullet_packings", "pybullet_shipped", "mujoco_engine", "mujoco_warp_engine", "dart", "ode")


def all_engines() -> dict[str, type]:
    """By name, in the order of the page. A module whose library is not there names its engines all the same."""
    found = {}
    for module in _modules:
        for engine in importlib.import_module(f".{module}", __name__).ENGINES:
            found[engine.name] = engine
    return found
