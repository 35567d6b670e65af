"""A sheet of pictures of rigged characters: the shaded mesh with its skeleton, and beside it the mesh with its joints bent.

    sheet.py OUT.png RIGGED.glb...                          names below
    sheet.py OUT.png --results results.json                 what evaluate.py left, with errors
    sheet.py OUT.png --wild WORK --details DETAILS.json     the folder of wild_eval.py --keep-glb and its --details
    sheet.py --self-test

Bones are red, joints of the left side yellow. The skeleton is looked at from its left front, so a character whose sides are
exchanged shows its back. Bent are arms, legs, spine, neck and tail, by the file's own weights: a mesh that tears or drags other
parts along has bad ones.
"""
import argparse
import json
import os
import re
import sys

import numpy as np

import glb
import png

WIDTH, HEIGHT, CAPTION = 230, 290, 44   # of a picture, and of the lines below a pair, in pixels
FINER = 2                               # pixels drawn a pixel shown, in both directions
GROUND, BONE, LEFT, RIGHT = (250, 250, 248), (215, 25, 30), (255, 200, 0), (120, 10, 15)


# --- drawing ---

def draw_triangles(corners, shades, size):
    """Grey values where triangles are, nan elsewhere. corners: n x 3 x (x, y, depth), the smaller depth in front."""
    width, height = size
    grey, depth = np.full(width * height, np.nan), np.full(width * height, np.inf)
    low = np.floor(corners[:, :, :2].min(1)).astype(int)
    extent = (np.ceil(corners[:, :, :2].max(1)).astype(int) - low).max(1) + 1
    area = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    side = 4
    rest = np.flatnonzero(np.abs(area) > 1e-12)
    while len(rest):  # those of about the same size at once
        group, rest = rest[extent[rest] <= side], rest[extent[rest] > side]
        y, x = np.divmod(np.arange(side * side), side)
        step = max(1, 2_000_000 // (side * side))
        for first in range(0, len(group), step):
            t = group[first:first + step]
            px, py = low[t, 0, None] + x, low[t, 1, None] + y
            inside = (px >= 0) & (py >= 0) & (px < width) & (py < height)
            point = np.stack([px + 0.5, py + 0.5], -1)
            z = np.zeros(px.shape)
            for k in range(3):
                a, b = corners[t, (k + 1) % 3, None], corners[t, (k + 2) % 3, None]
                share = cross(b - a, point - a[..., :2]) / area[t, None]
                inside &= share >= 0
                z += share * corners[t, k, 2, None]
            pixel, z, shade = (py * width + px)[inside], z[inside], np.broadcast_to(shades[t, None], px.shape)[inside]
            order = np.argsort(-z, kind="stable")  # the nearest last: it stays
            order = order[z[order] < depth[pixel[order]]]
            grey[pixel[order]], depth[pixel[order]] = shade[order], z[order]
        side *= 2
    return grey.reshape(height, width)


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def draw_line(pixels, a, b, radius, colour):
    """A line with round ends; a = b: a disc."""
    low = np.maximum(np.floor(np.minimum(a, b) - radius).astype(int), 0)
    high = np.minimum(np.ceil(np.maximum(a, b) + radius).astype(int) + 1, pixels.shape[1::-1])
    if (low >= high).any():
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    along = np.asarray(b) - a
    t = np.clip(((x - a[0]) * along[0] + (y - a[1]) * along[1]) / max(along @ along, 1e-12), 0, 1)
    near = np.hypot(x - a[0] - t * along[0], y - a[1] - t * along[1]) <= radius
    pixels[low[1]:high[1], low[0]:high[0]][near] = colour


# --- skeletons ---

def side_of(name):
    """L, R or nothing."""
    found = re.search(r"(left|right)|(?:^|[^a-z])([lr])(?=$|[^a-z])", name.lower())
    return (found.group(1) or found.group(2))[0].upper() if found else ""


def plain(name):
    """Without the side and all that is no letter: UpperArm.L, mixamorig:LeftArm -> upperarm, arm."""
    low = re.sub(r"^.*:", "", name.lower())
    low = re.sub(r"left|right|(?:^|(?<=[^a-z]))[lr](?=$|[^a-z])", "", low)
    return re.sub(r"[^a-z]", "", low)


class Skeleton:
    def __init__(self, file):
        self.joints = file.joints()
        self.names = {j: file.nodes[j].get("name", "") for j in self.joints}
        self.places = {j: file.worlds[j][:3, 3] for j in self.joints}
        known, self.parents = set(self.joints), {}
        for joint in self.joints:
            above = file.parents.get(joint)
            while above is not None and above not in known:
                above = file.parents.get(above)
            self.parents[joint] = above
        self.across, self.up, self.forward = self.axes()

    def mean_of(self, pattern, side=""):
        found = [p for j, p in self.places.items() if re.search(pattern, plain(self.names[j])) and side_of(self.names[j]).startswith(side)]
        return np.mean(found, axis=0) if found else None

    def axes(self):
        """To the character's left, up and forward, by its joints; x, y and z where they do not show it."""
        up, legs, feet = np.array([0.0, 1, 0]), self.mean_of("upperleg|upleg|thigh"), self.mean_of("foot|ankle")
        if legs is not None and feet is not None and (legs != feet).any():
            axis = np.argmax(np.abs(legs - feet))
            up = np.eye(3)[axis] * np.sign((legs - feet)[axis])
        pairs = [self.mean_of("leg|arm|thigh|shoulder|foot", side) for side in "LR"]
        across = pairs[0] - pairs[1] if all(p is not None for p in pairs) else np.zeros(3)
        across = across - up * (across @ up)
        if np.linalg.norm(across) < 1e-9:
            across = np.cross(up, [0, 0, 1]) if abs(up[2]) < 0.5 else np.array([1.0, 0, 0])
        across = across / np.linalg.norm(across)
        return across, up, np.cross(across, up)

    def bend_of(self, joint):
        """Where the bone of a joint is turned to, and by how many degrees."""
        name, left = plain(self.names[joint]), side_of(self.names[joint]) == "L"
        if re.search("lowerarm|forearm|elbow", name):
            return self.forward + 0.5 * self.up, 40
        if re.search("arm$", name):
            return (self.up, 40) if left else (self.forward, 45)
        if re.search("lowerleg|shin|calf|knee", name) or name == "leg":
            return (-self.forward, 40) if left != ("front" in name) else (-self.forward, 15)
        if re.search("upperleg|upleg|thigh|leg$", name):
            return (self.forward, 35) if left != ("hind" in name or "back" in name) else (-self.forward, 25)
        if re.fullmatch("spine|abdomen|chest|torso|neck", name):
            return (self.across, 10) if name != "neck" else (-self.across, 20)
        return (self.across, 20) if name.startswith("tail") else (self.up, 0)

    def bends(self):
        """World matrix by joint that bends the character. Where no name says what a joint is, all of them a little."""
        wanted = {j: self.bend_of(j) for j in self.joints}
        if sum(angle != 0 for _, angle in wanted.values()) < 3:
            wanted = {j: (self.across if i % 2 else self.up, 12) for i, j in enumerate(self.joints)}
        result = {}
        for joint in self.joints:
            ends = [self.places[c] for c in self.joints if self.parents[c] == joint]
            above = self.parents[joint]
            start = self.places[above] if above is not None else self.places[joint] - self.up
            bone = np.mean(ends, axis=0) - self.places[joint] if ends else self.places[joint] - start
            target, angle = wanted[joint]
            axis = np.cross(bone, target)
            matrix = np.eye(4)
            if angle and np.linalg.norm(axis) > 1e-9:
                axis = axis / np.linalg.norm(axis)
                half = np.radians(angle) / 2
                matrix[:3, :3] = glb.turn([*(np.sin(half) * axis), np.cos(half)])
                matrix[:3, 3] = self.places[joint] - matrix[:3, :3] @ self.places[joint]
            result[joint] = result[above] @ matrix if above is not None else matrix
        return result


# --- pictures ---

def camera(skeleton, places):
    """Rows: to the right, down and away, for a look from the left front; at long bodies more from the side."""
    long = np.ptp(places @ skeleton.forward) > 1.1 * np.ptp(places @ skeleton.up)
    yaw, pitch = np.radians(60 if long else 25), np.radians(10)
    toward = np.cos(yaw) * skeleton.forward + np.sin(yaw) * skeleton.across
    right = np.cross(skeleton.up, toward)
    toward = np.cos(pitch) * toward + np.sin(pitch) * skeleton.up
    return np.array([right, -np.cross(toward, right), -toward])


def picture(skeleton, places, corners, bends=None):
    """The mesh; without bends its skeleton over it."""
    width, height = WIDTH * FINER, HEIGHT * FINER
    view = camera(skeleton, places)
    seen = places @ view.T
    low, high = seen.min(0), seen.max(0)
    scale = 0.92 * min(width / (high[0] - low[0] + 1e-9), height / (high[1] - low[1] + 1e-9))
    middle = np.array([width / 2, height / 2, 0])
    project = lambda p: (p - (low + high) / 2) * scale + middle
    triangles = project(seen)[corners]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    light = np.array([-0.45, -0.55, -0.7])
    facing = np.where(normals[:, 2:] > 0, -normals, normals)  # both sides look the same
    grey = draw_triangles(triangles, 95 + 120 * np.clip(facing @ light, 0, 1), (width, height))
    pixels = np.where(np.isnan(grey)[..., None], GROUND, np.nan_to_num(grey)[..., None]).astype(float)
    if bends is None:
        ends = {j: project(view @ p)[:2] for j, p in skeleton.places.items()}
        for joint, above in skeleton.parents.items():
            if above is not None:
                draw_line(pixels, ends[above], ends[joint], 1.1 * FINER, BONE)
        for joint, end in ends.items():
            draw_line(pixels, end, end, 2.2 * FINER, LEFT if side_of(skeleton.names[joint]) == "L" else RIGHT)
    return pixels.reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean((1, 3))


def pair(path, lines):
    """Both pictures of a character over its lines of text."""
    cell = np.full((HEIGHT + CAPTION, 2 * WIDTH, 3), GROUND, float)
    if path and os.path.exists(path):
        file = glb.File(path)
        skeleton = Skeleton(file)
        places, corners = file.mesh()
        cell[:HEIGHT, :WIDTH] = picture(skeleton, places, corners)
        bends = skeleton.bends()
        cell[:HEIGHT, WIDTH:] = picture(skeleton, *file.mesh(bends), bends)
    for row, line in enumerate(lines):
        png.write_text(cell, 10, HEIGHT + 4 + 19 * row, line, (30, 30, 30) if row == 0 else (190, 20, 25), 1 if len(line) > 37 else 2)
    cell[-1:], cell[:, -1:] = 215, 215
    return cell


def sheet(cells):
    columns = min(4, max(1, int(np.ceil(np.sqrt(len(cells) / 1.5)))))
    rows = -(-len(cells) // columns)
    result = np.full((rows * (HEIGHT + CAPTION), columns * 2 * WIDTH, 3), GROUND, float)
    for index, cell in enumerate(cells):
        y, x = index // columns * (HEIGHT + CAPTION), index % columns * 2 * WIDTH
        result[y:y + HEIGHT + CAPTION, x:x + 2 * WIDTH] = cell
    return np.clip(result, 0, 255).astype(np.uint8)


# --- which characters ---

def caption(result):
    if result.get("mean") is None:
        return "refused"
    verdict = f" {result['verdict']}" if result.get("verdict") else ""
    return f"{100 * result['mean']:.1f} %{' turned' if result.get('turned') else ''}{verdict}"


def of_results(path):
    with open(path) as file:
        return [(r["file"], [r["name"], caption(r)]) for rows in json.load(file).values() for r in rows]


def of_wild(folder, details):
    """Files and figures belong together whose times are the same; an input may be rigged by several models."""
    with open(details) as file:
        figures = {(r["wall"], r["cpu"]): r for experiment in json.load(file) for r in experiment["results"]}
    found = []
    for name in sorted(os.listdir(folder)):
        if name.startswith("rig_") and name.endswith(".json"):
            with open(f"{folder}/{name}") as file:
                report = json.load(file)
            result = figures.get((report["wall"], report["cpu"]))
            if result:
                turned = result.get("flips", 0) > result.get("pairs", 0) / 3
                found.append((f"{folder}/{name[:-5]}.glb", [name[4:-5], caption({**result, "turned": turned})]))
    return found


def self_test():
    rows = np.random.default_rng(0).integers(0, 256, (13, 7, 3), dtype=np.uint8)
    assert (png.decode(png.encode(rows)) == rows).all()
    assert png.text_mask("T", 2).sum() == 4 * 11 and png.text_mask("?").sum() == 0
    square = np.array([[[2, 2, 5], [18, 2, 5], [18, 18, 5]], [[2, 2, 5], [18, 18, 5], [2, 18, 5]]], float)
    front = np.array([[[8, 8, 1], [12, 8, 1], [12, 12, 9]]], float)  # sinks into the square
    grey = draw_triangles(np.vstack([square, front]), np.array([1.0, 1, 2]), (20, 20))
    assert np.isfinite(grey).sum() == 256 and grey[5, 5] == 1 and grey[8, 9] == 2 and grey[11, 11] == 1
    assert (np.nan_to_num(grey) == np.nan_to_num(draw_triangles(np.vstack([front, square]), np.array([2.0, 1, 1]), (20, 20)))).all()
    names = {"leftUpperArm": ("L", "upperarm"), "mixamorig:RightArm": ("R", "arm"), "thigh.L": ("L", "thigh"), "calf_r": ("R", "calf"),
             "tail1": ("", "tail"), "Leg": ("", "leg"), "leftFrontUpperLeg": ("L", "frontupperleg"), "lowerarm.r": ("R", "lowerarm")}
    assert {n: (side_of(n), plain(n)) for n in names} == names, {n: (side_of(n), plain(n)) for n in names}
    pixels = np.zeros((9, 9, 3))
    draw_line(pixels, np.array([1.5, 4.5]), np.array([7.5, 4.5]), 0.6, (255, 0, 0))
    assert (pixels[4, 1:8, 0] == 255).all() and pixels[:, :, 0].sum() == 7 * 255
    assert caption({"mean": 0.0312, "turned": True, "verdict": "poor"}) == "3.1 % turned poor" and caption({}) == "refused"
    print("pictures, letters, triangles, names of joints: as expected")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--self-test", action="store_true", help="only the parts, on known pixels")
    parser.add_argument("out", nargs="?")
    parser.add_argument("files", nargs="*")
    parser.add_argument("--results")
    parser.add_argument("--wild")
    parser.add_argument("--details")
    parser.add_argument("--limit", type=int, default=24, help="so many characters, taken evenly from those there are; 0: all")
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    chosen = [(f, [os.path.basename(f)]) for f in arguments.files]
    chosen += of_results(arguments.results) if arguments.results else []
    chosen += of_wild(arguments.wild, arguments.details) if arguments.wild and arguments.details else []
    if not arguments.out or not chosen:
        parser.error("nothing to draw")
    if 0 < arguments.limit < len(chosen):
        chosen = [chosen[i * len(chosen) // arguments.limit] for i in range(arguments.limit)]
    with open(arguments.out, "wb") as file:
        file.write(png.encode(sheet([pair(*c) for c in chosen])))
    print(arguments.out)


if __name__ == "__main__":
    sys.exit(main())
