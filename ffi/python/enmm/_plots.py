"""Pictures by matplotlib, which is only imported when one is drawn."""

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._abi import BlockFlag
from ._frames import Frame, Frames
from ._table import Table

if TYPE_CHECKING:
    from ._model import Model
    from ._results import Fos

UNITS = {"displacement": "m", "velocity": "m/s"} | dict.fromkeys(
    ("stress_xx", "stress_yy", "stress_xy", "mean_stress", "max_shear", "principal_max", "principal_min"), "Pa"
)


def axes(ax: Any, size: tuple[float, float] = (8, 5)) -> Any:
    """The given axes, or new ones."""
    if ax is not None:
        return ax
    return new_figure(size).subplots()


def new_figure(size: tuple[float, float]) -> Any:
    """A figure of matplotlib (inches)."""
    import matplotlib.pyplot

    plt: Any = matplotlib.pyplot
    return plt.figure(figsize=size, layout="constrained")


def frame(of: Frame, field: str, ax: Any, scale: float = 1.0, joints: bool = True) -> Any:
    """Draws the elements of a frame, and the joints where nothing is scaled."""
    from matplotlib.collections import LineCollection

    ax = axes(ax)
    collection = _elements(ax, of, field, scale)
    if joints and scale == 1.0:
        ax.add_collection(LineCollection(list(of.joints()), colors="black", linewidths=0.6))
    ax.autoscale_view()
    unit = UNITS.get(field)
    ax.figure.colorbar(collection, ax=ax, label=f"{field} ({unit})" if unit else field)
    ax.set_title(f"t = {of.time:.4g} s")
    return ax


def model(of: "Model", ax: Any) -> Any:
    """Draws the blocks of a model."""
    from matplotlib.collections import PolyCollection

    ax = axes(ax)
    blocks = of.blocks()
    there = blocks[blocks["flags"] & BlockFlag.REMOVED == 0]
    moved = np.hypot(there["displacement_x"], there["displacement_y"])
    outlines = [of.polygon(block) for block in there["id"].tolist()]
    collection = PolyCollection(outlines, array=moved, edgecolors="black", linewidths=0.6)
    ax.add_collection(collection)
    ax.set(aspect="equal", xlabel="x (m)", ylabel="y (m)", title=f"t = {of.time:.4g} s")
    ax.autoscale_view()
    ax.figure.colorbar(collection, ax=ax, label="displacement (m)")
    return ax


def _elements(ax: Any, of: Frame, field: str, scale: float = 1.0) -> Any:
    from matplotlib.collections import PolyCollection

    values = of.of_elements(field)
    points = of.points + (scale - 1.0) * of.point_data["displacement"]
    collection = PolyCollection(np.split(points, of.ends[:-1]), array=values, edgecolors="face", linewidths=0.2)
    ax.add_collection(collection)
    ax.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
    return collection


def history(table: Table, names: Sequence[str], ax: Any) -> Any:
    """Draws columns over time."""
    ax = axes(ax)
    names = names or [name for name in table if name.endswith(("_ux", "_uy"))] or list(table)[1:]
    for name in names:
        ax.plot(table["time"], table[name], label=name)
    units = sorted({table.units[name] for name in names})
    ax.set(xlabel="time (s)", ylabel=", ".join(unit for unit in units if unit))
    ax.legend()
    return ax


def animation(frames: Frames, field: str, fps: int, path: str | os.PathLike[str] | None) -> Any:
    """Animates frames on one scale of colours."""
    from matplotlib.animation import FuncAnimation

    if not len(frames):
        raise ValueError("the run has no frames: leave out `output.frames = false`, or set `output.frame_interval`")
    whole = list(frames)
    values = [of.of_elements(field) for of in whole]
    ax = axes(None)
    collection = _elements(ax, whole[0], field)
    collection.set_clim(min(map(np.min, values)), max(map(np.max, values)))
    low, high = (pick([pick(of.points, axis=0) for of in whole], axis=0) for pick in (np.min, np.max))
    margin = 0.02 * (high - low)
    ax.set(xlim=(low[0] - margin[0], high[0] + margin[0]), ylim=(low[1] - margin[1], high[1] + margin[1]))
    unit = UNITS.get(field)
    ax.figure.colorbar(collection, ax=ax, label=f"{field} ({unit})" if unit else field)

    def show(k: int) -> tuple[Any]:
        collection.set_verts(whole[k].polygons())
        collection.set_array(values[k])
        ax.set_title(f"t = {whole[k].time:.4g} s")
        return (collection,)

    made = FuncAnimation(ax.figure, show, frames=len(whole), interval=1000 / fps)
    if path is not None:
        made.save(os.fspath(path), fps=fps)
    return made


def trials(found: "Fos", ax: Any) -> Any:
    """Draws the trials of a factor of safety."""
    ax = axes(ax)
    table = found.trials
    stable = table["verdict"] == "stable"
    for which, mark, label in ((stable, "o", "stable"), (~stable, "x", "fails")):
        ax.plot(table["factor"][which], table["displacement"][which], mark, label=label)
    if found.factor is not None:
        ax.axvline(found.factor, color="0.5", label=f"factor of safety {found.factor:.3f}")
    ax.set(xlabel="strength divided by", ylabel="displacement (m)", yscale="log")
    ax.legend()
    return ax
