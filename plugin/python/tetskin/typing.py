# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Types of arguments, like those of numpy.typing: for your own annotations, and for tools that read ours."""

from typing import Any, Protocol, Sequence, SupportsFloat, Union

import numpy.typing


class SupportsArray(Protocol):
    """Accepted by numpy.asarray: arrays, tensors, columns of a table."""

    def __array__(self) -> numpy.typing.NDArray[Any]: ...


class HasFaces(Protocol):
    """Such as trimesh's Trimesh."""

    @property
    def vertices(self) -> Any:
        """(n, 3) numbers, any unit."""

    @property
    def faces(self) -> Any:
        """(m, 3) integers, counter-clockwise from outside."""


class HasTriangles(Protocol):
    """Such as Open3D's TriangleMesh."""

    @property
    def vertices(self) -> Any:
        """(n, 3) numbers, any unit."""

    @property
    def triangles(self) -> Any:
        """(m, 3) integers, counter-clockwise from outside."""


class HasCells(Protocol):
    """Such as meshio's Mesh."""

    @property
    def points(self) -> Any:
        """(n, 3) numbers, any unit."""

    def get_cells_type(self, cell_type: str) -> Any:
        """Of the type "triangle": (m, 3) integers, counter-clockwise from outside."""


#: A mesh of another package.
Mesh = Union[HasFaces, HasTriangles, HasCells]
#: Numbers, indices or a mask, of one or two dimensions: an array, or sequences. Each argument says which shape it takes.
Array = Union[SupportsArray, Sequence[Union[SupportsFloat, SupportsArray, Sequence[SupportsFloat]]]]
#: Three numbers, or the four of a quaternion (x, y, z, w).
Vector = Union[SupportsArray, Sequence[SupportsFloat]]
