"""Frames of a run: the elements with their displacements, velocities and stresses at one time."""

import base64
import xml.etree.ElementTree
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Protocol, overload

import numpy as np
import numpy.typing as npt

from . import _html
from ._options import index as index_of

_TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "Int8": "i1"} | {
    "UInt64": "<u8",
    "UInt32": "<u4",
    "UInt8": "u1",
}


class Frame:
    """The elements at one time. Points are not shared between elements, because displacements jump at joints."""

    time: float
    """Time (s) from the start of the run."""
    points: npt.NDArray[np.float64]
    """Corners of all elements now (m), shape (points, 2)."""
    ends: npt.NDArray[np.int64]
    """For each element the index behind its last point."""
    point_data: dict[str, npt.NDArray[Any]]
    """`displacement` (m), `velocity` (m/s): shape (points, 2)."""
    cell_data: dict[str, npt.NDArray[Any]]
    """A value for each element: `stress_xx`, `principal_min`, ... (Pa, tension positive), `block`, `rock`.

    `stress` is the tensor: xx, yy, zz, xy, yz, xz, of which yz and xz are zero.
    """

    def __init__(self, time: float, path: Path, joints: Path | None = None) -> None:
        self.time = time
        self._joints = joints
        read, piece = _Reader.of(path)
        self.points = read.arrays(piece.find("Points")).popitem()[1][:, :2]
        self.ends = read.arrays(piece.find("Cells"))["offsets"].astype(np.int64)
        of_points = read.arrays(piece.find("PointData"))
        self.point_data = {name: data[:, :2] if data.ndim == 2 else data for name, data in of_points.items()}
        self.cell_data = read.arrays(piece.find("CellData"))

    def polygons(self) -> list[npt.NDArray[np.float64]]:
        """Outline of every element now, counter-clockwise: a point (m) in each row."""
        return np.split(self.points, self.ends[:-1])

    def joints(self) -> npt.NDArray[np.float64]:
        """The joints now: for each piece its two ends (m), shape (pieces, 2, 2)."""
        if self._joints is None:
            return np.empty((0, 2, 2))
        read, piece = _Reader.of(self._joints)
        points = read.arrays(piece.find("Points")).popitem()[1][:, :2]
        corners: npt.NDArray[np.float64] = points[read.arrays(piece.find("Cells"))["connectivity"]]
        return corners.reshape(-1, 2, 2)

    def to_pyvista(self) -> Any:
        """The elements as an unstructured grid of pyvista, with all fields; vectors have a third component of 0."""
        import pyvista

        sizes = np.diff(self.ends, prepend=0)
        cells = np.insert(np.arange(len(self.points)), self.ends - sizes, sizes)
        kinds = np.full(len(sizes), pyvista.CellType.POLYGON)
        grid = pyvista.UnstructuredGrid(cells, kinds, _in_space(self.points))
        for name, data in self.point_data.items():
            grid.point_data[name] = _in_space(data) if data.ndim == 2 else data
        for name, data in self.cell_data.items():
            grid.cell_data[name] = data
        grid.field_data["TimeValue"] = [self.time]
        return grid

    def of_elements(self, name: str) -> npt.NDArray[Any]:
        """A value for each element: cell data, or the mean length of a vector of its points."""
        if name in self.cell_data and self.cell_data[name].ndim == 1:
            return self.cell_data[name]
        if name in self.cell_data:
            raise KeyError(f"{name!r}: the field is a tensor; choose one of its parts, such as stress_yy")
        if name not in self.point_data:
            there = ", ".join([*self.point_data, *self.cell_data])
            raise KeyError(f"{name!r}: the frame has no such field; there are: {there}")
        data = self.point_data[name]
        size = np.hypot(*data.T) if data.ndim == 2 else data
        starts = np.r_[0, self.ends[:-1]]
        return np.asarray(np.add.reduceat(size, starts) / (self.ends - starts))

    def __repr__(self) -> str:
        return f"<enmm.Frame: t = {self.time:g} s, {len(self.ends)} elements>"


def _in_space(vectors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Vectors of the plane with a z of 0."""
    return np.pad(vectors, ((0, 0), (0, 1)))


class Kept(Protocol):
    """What knows whether files are still those that were read about."""

    def check(self) -> None:
        """Raises when they are not."""


class Frames(Sequence[Frame]):
    """Frames of a run in the order of time; each is read when it is asked for."""

    times: npt.NDArray[np.float64]
    """Times (s) of the frames."""

    def __init__(self, collection: Path, kept: Kept | None = None) -> None:
        self._kept = kept
        self._files: list[tuple[float, Path, Path | None]] = []
        if collection.is_file():
            entries = list(xml.etree.ElementTree.parse(collection).getroot().iter("DataSet"))
            files = {(entry.attrib["timestep"], entry.get("part", "0")): entry.attrib["file"] for entry in entries}
            for (time, part), name in files.items():
                if part == "0":
                    joints = files.get((time, "1"))
                    beside = None if joints is None else collection.parent / joints
                    self._files.append((float(time), collection.parent / name, beside))
        self.times = np.array([time for time, _, _ in self._files])

    @overload
    def __getitem__(self, at: int) -> Frame: ...
    @overload
    def __getitem__(self, at: slice) -> list[Frame]: ...
    def __getitem__(self, at: int | slice) -> Frame | list[Frame]:
        if self._kept is not None:
            self._kept.check()
        if isinstance(at, slice):
            return [Frame(*file) for file in self._files[at]]
        k = index_of("frame", at)
        if not -len(self) <= k < len(self):
            raise IndexError(f"frame: is {k}, must be from {-len(self)} to {len(self) - 1}: there are {len(self)} frames")
        return Frame(*self._files[k])

    def __iter__(self) -> Iterator[Frame]:
        return (self[k] for k in range(len(self)))

    def __repr__(self) -> str:
        last = f", t = {self.times[0]:g} to {self.times[-1]:g} s" if len(self) else ""
        return f"<enmm.Frames: {len(self)}{last}>"

    def _repr_html_(self) -> str:
        return _html.facts([("frames", str(len(self))), ("times", ", ".join(f"{time:.4g} s" for time in self.times))])

    def __len__(self) -> int:
        return len(self._files)


class _Reader:
    """Reads the arrays of a VTK file in base64, as they are or compressed by zlib."""

    @classmethod
    def of(cls, path: Path) -> tuple["_Reader", xml.etree.ElementTree.Element]:
        """The reader of a file, and the piece that holds its arrays."""
        root = xml.etree.ElementTree.parse(path).getroot()
        piece = root.find("UnstructuredGrid/Piece")
        if root.get("type") != "UnstructuredGrid" or piece is None:
            raise ValueError(f"{path}: is no VTK unstructured grid with a piece; run the case again")
        return cls(root), piece

    def __init__(self, root: xml.etree.ElementTree.Element) -> None:
        self._header = np.dtype(_TYPES[root.get("header_type", "UInt32")])
        self._compressed = root.get("compressor") is not None

    def arrays(self, parent: xml.etree.ElementTree.Element | None) -> dict[str, npt.NDArray[Any]]:
        """Arrays by name, those of vectors with a row for each."""
        found: dict[str, npt.NDArray[Any]] = {}
        for k, element in enumerate(() if parent is None else parent.iter("DataArray")):
            if element.get("format") != "binary":
                raise ValueError(f"array {element.get('Name')}: has the format {element.get('format')}, must be binary")
            data = np.frombuffer(self._bytes("".join((element.text or "").split())), _TYPES[element.attrib["type"]])
            width = int(element.get("NumberOfComponents", "1"))
            found[element.get("Name", str(k))] = data.reshape(-1, width) if width > 1 else data
        return found

    def _bytes(self, text: str) -> bytes:
        size = self._header.itemsize
        if not self._compressed:
            return base64.b64decode(text)[size:]
        # Header: number of blocks, size of a block, size of the last, then the compressed size of each.
        count = int(np.frombuffer(base64.b64decode(text[: 4 * -(-size // 3)])[:size], self._header)[0])
        whole = (3 + count) * size
        letters = 4 * -(-whole // 3)
        sizes = np.frombuffer(base64.b64decode(text[:letters])[:whole], self._header)[3:]
        data, at = base64.b64decode(text[letters:]), 0
        blocks: list[bytes] = []
        for length in sizes.tolist():
            blocks.append(zlib.decompress(data[at : at + length]))
            at += length
        return b"".join(blocks)
