"""3D tracking of hands and objects from stereo pictures.

Pictures are numpy arrays uint8 (height, width, 3) in the order blue, green, red, as OpenCV has them.
Lengths are metres, angles radians, quaternions w x y z. Errors are exceptions derived from Error.

    session = hypotrack.Session("scene.yaml")
    tracker = session.tracker(hypotrack.load_calibration("rig.yaml"))
    solution = tracker.track(left, right, time=0.0)
    print(solution.status, solution["hand.index_tip"])
"""

from . import _core
from ._core import *  # noqa: F401,F403
from ._core import register, version as __version__

__all__ = [name for name in dir(_core) if not name.startswith("_") and name != "version"]
__all__ += ["plugin"]


def plugin(kind, name):
    """Registers the class below as a plugin: `@hypotrack.plugin("optimizer", "mine")`."""

    def decorate(cls):
        register(kind, name, cls)
        return cls

    return decorate


for _name in __all__:
    _member = globals()[_name]
    if isinstance(_member, type):
        _member.__module__ = "hypotrack"
del _name, _member
