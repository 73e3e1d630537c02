"""Meshes that are made when they are needed, and the scenes around them."""

from pathlib import Path

import numpy as np

MADE = Path(__file__).parent / "made"

FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def write_ply(path, positions, triangles, uvs=None):
    """A binary PLY file, little-endian, with float positions and int indices, as most programs write them."""
    values = positions if uvs is None else np.hstack([positions, uvs])
    names = ["x", "y", "z"] + ([] if uvs is None else ["u", "v"])
    faces = np.empty(len(triangles), FACE)
    faces["count"], faces["corners"] = 3, triangles
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(values)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header\n"]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(np.ascontiguousarray(values, "<f4").tobytes())
        file.write(faces.tobytes())


def read_ply(path):
    """Positions and triangles of a file that `write_ply` wrote."""
    with open(path, "rb") as file:
        counts, columns = [], 0
        for line in iter(file.readline, b"end_header\n"):
            counts += [int(line.split()[2])] if line.startswith(b"element") else []
            columns += line.startswith(b"property float")
        values = np.fromfile(file, "<f4", counts[0] * columns).reshape(-1, columns)
        return values[:, :3], np.fromfile(file, FACE, counts[1])["corners"]


def stone(triangles):
    """A displaced sphere of about so many triangles: the same shape at every count, rough at all scales."""
    rows = max(3, round(np.sqrt(triangles / 4)))
    columns = 2 * rows
    theta, phi = np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, columns, endpoint=False)
    sin, cos = np.sin(theta)[:, None], np.cos(theta)[:, None]
    unit = np.stack([sin * np.cos(phi), cos * np.ones(columns), sin * np.sin(phi)], -1).astype(np.float32)
    radius = np.ones(unit.shape[:2], np.float32)
    random = np.random.default_rng(1)
    for octave in range(7):
        for _ in range(3):
            axis, phase = random.normal(size=3), random.uniform(0, 2 * np.pi)
            axis *= 3 * 2**octave / np.linalg.norm(axis)
            radius += 0.08 / 1.9**octave * np.sin(unit @ axis.astype(np.float32) + np.float32(phase))
    positions = (unit * radius[..., None]).reshape(-1, 3) + np.float32([0, 1.2, 0])
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    at = lambda r, c: (r * columns + c % columns).ravel()
    a, b, c, d = at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)
    return positions, np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)


def confetti(count):
    """So many small triangles in a slab, turned anyhow; their area is the same in sum whatever the count."""
    random = np.random.default_rng(2)
    centers = random.uniform([-3, 1.5, -3], [3, 2.5, 3], (count, 1, 3))
    corners = random.normal(size=(count, 3, 3))
    corners -= corners.mean(1, keepdims=True)
    a, b, c = corners.swapaxes(0, 1)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    corners *= np.sqrt(0.5 / count / area)[:, None, None]
    return (centers + corners).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


HEAD = """Film "rgb" "integer xresolution" {width} "integer yresolution" {height}
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 5
LookAt {look}  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
"""
FLOOR = """Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "trianglemesh" "point3 P" [ -8 0 -8  -8 0 8  8 0 8  8 0 -8 ] "integer indices" [ 0 1 2 0 2 3 ]
"""
STONE_LOOK = "0 2.4 5.5  0 1.1 0"
STONE_ITSELF = """Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "plymesh" "string filename" "{ply}"
"""
STONE = """LightSource "infinite" "rgb L" [ 0.4 0.45 0.55 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 20 18 15 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "trianglemesh" "point3 P" [ 2 5 1  4 5 1  4 5 3  2 5 3 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
""" + STONE_ITSELF
CONFETTI = """AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 10 9 8 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "plymesh" "string filename" "{ply}"
AttributeEnd
"""


def stone_scene(triangles, width=160, height=120):
    """A scene with a stone under sky and a lamp; its files are kept for the next time."""
    make = lambda: stone(triangles)
    return scene(f"stone-{triangles}", f"-{width}x{height}", make, STONE_LOOK, STONE, width, height)


def confetti_scene(count):
    """A scene with so many small lamps over a floor."""
    return scene(f"confetti-{count}", "", lambda: confetti(count), "0 4 8  0 0.8 0", CONFETTI, 160, 120)


def lit_stone_scene(count):
    """A stone of a million triangles below so many small lamps."""
    stone_scene(1_000_000)
    lamps = CONFETTI.replace("AttributeBegin", "AttributeBegin\n  Translate 0 1.5 0")
    body = lamps + STONE_ITSELF.format(ply="stone-1000000.ply")
    return scene(f"confetti-{count}", "-stone", lambda: confetti(count), STONE_LOOK, body, 160, 120)


def scene(name, variant, mesh, look, body, width, height):
    MADE.mkdir(exist_ok=True)
    ply, path = MADE / f"{name}.ply", MADE / f"{name}{variant}.pbrt"
    if not ply.exists():
        write_ply(ply, *mesh())
    head = HEAD.format(width=width, height=height, look=look)
    path.write_text(head + body.format(ply=ply.name) + FLOOR)
    return path


def inline_scene(triangles):
    """The stone written out in the scene file itself, at 16 × 12 pixels."""
    path = MADE / f"stone-{triangles}-inline.pbrt"
    MADE.mkdir(exist_ok=True)
    if not path.exists():
        positions, corners = stone(triangles)
        head = HEAD.format(width=16, height=12, look=STONE_LOOK)
        lines = lambda rows, form: "\n".join(" ".join(form % v for v in row) for row in rows.tolist())
        mesh = f'"point3 P" [\n{lines(positions, "%.7g")}\n]\n"integer indices" [\n{lines(corners, "%d")}\n]\n'
        body = STONE.format(ply="").rsplit("Shape", 1)[0] + 'Shape "trianglemesh" ' + mesh
        path.write_text(head + body + FLOOR)
    return path
