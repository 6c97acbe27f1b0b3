# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The cases to run. A scene's plan(quick) lists them."""
from dataclasses import asdict, dataclass, field


@dataclass(frozen=True)
class Case:
    """peer: a module of `adapters`. curve: points of one curve in the plots. setting: arguments of its Simulation.
    mesh: a name that the scene knows. example: whether this is the setting of the peer's own example."""
    peer: str
    curve: str
    setting: dict = field(default_factory=dict)
    mesh: str = ""
    example: bool = False

    @property
    def words(self):
        """The setting in words."""
        return ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in self.setting.items())

    def as_dict(self):
        return asdict(self)


def cases(peer, curve, settings, example=None, mesh=""):
    """A curve: one case for each setting. example: the entries of the setting of the peer's own example."""
    is_example = lambda setting: example is not None and example.items() <= setting.items()  # noqa: E731
    return [Case(peer, curve, setting, mesh, is_example(setting)) for setting in settings]


def usual(quick, many=False):
    """For scenes with contact: each peer in the setting of its own example, and unless quick in finer ones.

    many: bodies or contacts, for which those that take half a minute and more are tried in one setting.
    """
    of = lambda counts, **more: [{"substeps": n, **more} for n in counts]  # noqa: E731
    planned = [
        *cases("tetskin", "world", of((4,) if quick else (2, 4, 8, 16)), {"substeps": 4}),
        *cases("rapier", "constraints", of((4,) if quick else (4, 8, 16)), {"substeps": 4}),
        *cases("mujoco", "discrete", of((16,)), {"substeps": 16}),
        *cases("pybullet", "neo-Hookean", of((4,) if quick or many else (4, 16)), {"substeps": 4}),
        *cases("newton", "VBD", of((10,), iterations=10), {"substeps": 10}),
    ]
    if not quick:
        fem = of((4,) if many else (4, 16), solver="fem", iterations=100)
        planned += cases("rapier", "finite elements", fem, {"substeps": 4})
    return planned
