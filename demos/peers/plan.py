# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""What is run: cases. A scene's plan(quick) lists them."""
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
