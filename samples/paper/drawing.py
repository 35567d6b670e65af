"""Pictures of meshes and charts, by matplotlib, and the parts of the page, which holds them all in itself."""
import base64
import functools
import html
import inspect
import io
import math

import numpy as np
from matplotlib import cm
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

RED, GREEN, BLUE, AMBER, GREY, HUES = "#d92626", "#0a7d3c", "#2563eb", "#d97706", "#444444", cm.tab20
VOTES = LinearSegmentedColormap.from_list("votes", ["#ccc7bd", "#fadb8c", "#f79940", "#d93829", "#800a29"])
HEAD = """<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>The experiments of Xia et al. 2016</title><style>
body { font: 16px/1.45 sans-serif; max-width: 1180px; margin: auto; padding: 1.2rem; } .row { display: grid; gap: .4rem; }
img { max-width: 100%; border-radius: 8px; } figure { margin: 0; text-align: center; font-size: .8em; }
table { border-collapse: collapse; margin: .6rem 0; } th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #999; }
</style><h1>The experiments of Xia et al. 2016</h1><p>Q. Xia, S. Li, H. Qin, A. Hao, <i>Automatic Extraction of Generic Focal Features on 3D
Shapes via Random Forest Regression Analysis of Geodesics-in-Heat</i>, 2016: its tables and figures reproduced, with the method exactly as
published (preset <b>paper</b>) and with the most accurate one (preset <b>default</b>), side by side. No model was trained on a test shape.
Votes run from grey (none) over yellow to dark red (most). A green circle is marked by hand, a blue ball is found. Numbers in captions are
errors in mean edge lengths of the test mesh.</p>\n"""


def section(docstring, body, values):
    """Of a table or figure: its title and its words are the docstring of the function that makes it."""
    title, _, words = inspect.cleandoc(docstring).format(**values).partition("\n")
    return f"<section><h3>{title}</h3><p>{words}</p>{body}</section>\n"


def table(head, *rows):
    cells = [[f"<th>{name}" for name in head], *([f"<td>{html.escape(str(cell))}" for cell in row] for row in rows)]
    return "<table>" + "\n".join("<tr>" + "".join(line) for line in cells) + "</table>\n"


def row(pictures, columns=0):
    return f'<div class="row" style="grid-template-columns: repeat({columns or len(pictures)}, minmax(0, 230px))">{"".join(pictures)}</div>\n'


def fixed(value, digits=2):
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def image_of(figure, words, width):
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return f'<img alt="{html.escape(words)}" width="{width}" src="data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}">'


def chart(title, x, curves):
    """curves: (name, colour, values), then where there are any: the place on the axis of each value, and matplotlib's format of a point."""
    figure = Figure((3.6, 2.6), dpi=130, facecolor="#f7f5f1", layout="constrained")
    axes = figure.add_subplot(facecolor="none", xlabel=x)
    for name, colour, values, *more in curves:
        places, style = (*more, None, None)[:2]
        axes.plot(range(len(values)) if places is None else places, values, style or "-", color=colour, label=name, markersize=1.5)
    axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
    axes.set_title(title, fontsize=9, loc="left")
    axes.grid(color="#ddd")
    if any(name for name, *_ in curves):
        axes.legend(fontsize=7, frameon=False)
    return image_of(figure, title, 360)


def facing(mesh, view, points=()):
    """The triangles that face the viewer: corners and normals, turned, and which ones they are; and points, turned.
    x right, y up, z towards the viewer. view: degrees the mesh is turned about +Y, and degrees the viewer looks down on it."""
    (a, b), (c, d) = np.sin(np.radians(view)), np.cos(np.radians(view))
    turn = np.array([[c, b * a, -d * a], [0, d, b], [a, -b * c, d * c]])
    corners = (mesh.vertices @ turn)[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    front = normals[:, 2] > 0
    return corners[front], normals[front], front, [np.asarray(point) @ turn for point in points]


def hidden(point, corners):
    """Whether one of the triangles lies clearly in front of a point."""
    a, b, c = ((corners[:, k] - point).T for k in range(3))
    weights = np.stack([b[0] * c[1] - b[1] * c[0], c[0] * a[1] - c[1] * a[0], a[0] * b[1] - a[1] * b[0]], axis=1)
    weights, depths = (part[(weights >= 0).all(axis=1)] for part in (weights, corners[:, :, 2] - point[2]))
    return bool(((weights * depths).sum(axis=1) > weights.sum(axis=1) * 0.05 * np.ptp(corners[:, 0, :2], axis=0).max()).any())


@functools.lru_cache(maxsize=64)
def view_of(mesh, *points):
    """The view that shows most of the surface around the points, with nothing before them; from below where that shows much more."""
    apart = np.linalg.norm(mesh.vertices[:, None] - np.asarray(points), axis=2)
    heat = np.exp(-(apart / (apart.max() / 5))**2).sum(axis=1)[mesh.faces].mean(axis=1)
    width, height, depth = np.ptp(mesh.vertices, axis=0)
    level, best, most = 50 if 2 * height < max(width, depth) else 10, None, 0
    for view in [(yaw, pitch) for pitch in (level, -level) for yaw in range(0, 360, 30)]:
        corners, normals, front, places = facing(mesh, view, points)
        shown = (heat[front] * normals[:, 2]).sum() * (1 - 0.75 * np.mean([hidden(place, corners) for place in places]))
        shown /= 1.5 if view[1] < 0 else 1
        if best is None or shown > 1.02 * most:
            best, most = view, shown
    return best


def picture(mesh, caption, view, paint=None, marks=(), bones=()):
    """paint: 0..1 for each vertex, or the number of a part for each triangle. marks: (place, colour), with a third member hollow ones; bones:
    pairs of numbers of marks."""
    corners, normals, front, places = facing(mesh, view, [place for place, *_ in marks])
    order = np.argsort(corners[:, :, 2].sum(axis=1))
    paint = np.zeros(mesh.vertex_count) if paint is None else paint
    colours = HUES(paint[front] % 20) if paint.dtype.kind == "i" else VOTES(paint[mesh.faces[front]].mean(axis=1))
    light = 0.55 + 0.6 * np.maximum(0, normals @ (-0.45, 0.6, 0.65) / np.linalg.norm(normals, axis=1))
    colours = np.clip(colours[:, :3] * light[:, None], 0, 1)[order]
    figure = Figure((2.3, 3.0), dpi=150, facecolor="#f7f5f1")
    axes = figure.add_axes([0.04, 0.04, 0.92, 0.92], aspect="equal", frame_on=False, xticks=[], yticks=[])
    axes.add_collection(PolyCollection(corners[order][:, :, :2], facecolors=colours, edgecolors=colours, linewidths=0.2))
    axes.autoscale_view()
    for bone in bones:
        axes.plot(*np.transpose([places[i][:2] for i in bone]), color="#222222", linewidth=1.4)
    for place, (_, colour, *hollow) in zip(places, marks):
        axes.plot(*place[:2], "o", markersize=5, markerfacecolor="none" if hollow else colour, markeredgecolor=colour if hollow else "#222222",
                  markeredgewidth=1.4 if hollow else 0.5, alpha=0.3 if hidden(place, corners) else 1)
    return f"<figure>{image_of(figure, caption, 230)}<figcaption>{html.escape(caption)}</figcaption></figure>"
