"""Reads as much of pbrt's format as the scenes of the comparison use, into plain values that the twins are made from."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import color

TOKEN = re.compile(r'#[^\n]*|"([^"]*)"|([\[\]])|([^\s"\[\]]+)')


@dataclass
class Shape:
    """A sphere or a mesh, in world space."""

    material: dict
    emission: tuple | None = None
    center: np.ndarray | None = None
    radius: float = 0.0
    file: Path | None = None  # of a mesh that has a file of its own
    positions: np.ndarray | None = None
    triangles: np.ndarray | None = None
    uvs: np.ndarray | None = None

    @property
    def is_sphere(self):
        return self.center is not None


@dataclass
class Scene:
    path: Path
    width: int = 0
    height: int = 0
    samples: int = 16
    max_depth: int = 5
    eye: np.ndarray = None
    target: np.ndarray = None
    up: np.ndarray = None
    fov: float = 90.0  # across the shorter side, in degrees
    lens_radius: float = 0.0
    focal_distance: float = 1e6
    sky: tuple | None = None
    shapes: list = field(default_factory=list)


def tokens(text):
    for string, bracket, word in (m.groups() for m in TOKEN.finditer(text)):
        if bracket or word:
            yield bracket or word
        elif string is not None:
            yield '"' + string


def read(path):
    """The scene of a file; fails on what it does not know, lest a twin lack something."""
    path = Path(path)
    scene, words = Scene(path), list(tokens(path.read_text()))
    state = {"ctm": np.eye(4), "material": {"kind": "diffuse", "reflectance": ("rgb", [0.5] * 3)}, "emission": None}
    stack, textures, at = [], {}, 0

    def value(kind, values):
        if kind == "spectrum" and values[0].startswith('"'):
            return ("named", values[0][1:])
        if kind == "spectrum":
            n = [float(v) for v in values]
            return ("spectrum", list(zip(n[::2], n[1::2])))
        if kind == "rgb":
            return ("rgb", [float(v) for v in values])
        if kind == "texture":
            return textures[values[0][1:]]
        if kind in ("string", "bool"):
            return values[0].lstrip('"')
        if kind == "integer":
            return np.array(values, np.int64) if len(values) > 1 else int(values[0])
        return np.array(values, np.float64) if len(values) > 1 else float(values[0])

    def params():
        nonlocal at
        found = {}
        while at < len(words) and words[at].startswith('"'):
            kind, name = words[at][1:].split()
            at += 1
            values = [words[at]]
            if words[at] == "[":
                end = words.index("]", at)
                values, at = words[at + 1 : end], end
            at += 1
            found[name] = value(kind, values)
        return found

    def numbers(count):
        nonlocal at
        at += count
        return [float(w) for w in words[at - count : at]]

    def name():
        nonlocal at
        at += 1
        return words[at - 1][1:]

    def move(matrix):
        state["ctm"] = state["ctm"] @ matrix

    while at < len(words):
        directive, at = words[at], at + 1
        if directive == "Film":
            name()
            p = params()
            scene.width, scene.height = p["xresolution"], p["yresolution"]
        elif directive == "PixelFilter":
            kind, p = name(), params()
            assert kind == "box" and p["xradius"] == p["yradius"] == 0.5, "the twins' filter is a box of one pixel"
        elif directive == "Sampler":
            name()
            scene.samples = params()["pixelsamples"]
        elif directive == "Integrator":
            assert name() == "path"
            scene.max_depth = params()["maxdepth"]
        elif directive == "LookAt":
            scene.eye, scene.target, scene.up = np.array(numbers(9)).reshape(3, 3)
        elif directive == "Camera":
            assert name() == "perspective"
            p = params()
            scene.fov = p["fov"]
            scene.lens_radius, scene.focal_distance = p.get("lensradius", 0.0), p.get("focaldistance", 1e6)
        elif directive == "WorldBegin":
            state["ctm"] = np.eye(4)
        elif directive == "AttributeBegin":
            stack.append(dict(state))
        elif directive == "AttributeEnd":
            state = stack.pop()
        elif directive == "Translate":
            matrix = np.eye(4)
            matrix[:3, 3] = numbers(3)
            move(matrix)
        elif directive == "Rotate":
            angle, *axis = numbers(4)
            move(rotation(np.radians(angle), np.array(axis)))
        elif directive == "LightSource":
            assert name() == "infinite"
            scene.sky = params()["L"]
        elif directive == "AreaLightSource":
            assert name() == "diffuse"
            state["emission"] = emission(params()["L"])
        elif directive == "Texture":
            texture, _, kind = name(), name(), name()
            assert kind == "checkerboard"
            p = params()
            textures[texture] = ("checks", p["uscale"], p["vscale"], p["tex1"], p["tex2"])
        elif directive == "Material":
            state["material"] = {"kind": name(), **params()}
        elif directive == "Shape":
            kind = name()
            scene.shapes.append(shape(kind, params(), state, path.parent))
        else:
            raise ValueError(f"{path}: the twins know no {directive}")
    return scene


def emission(value):
    """Of a light: pbrt scales a spectrum of pairs to luminance one."""
    if value[0] == "spectrum":
        luminance = color.luminance_of(value[1])
        return ("spectrum", [(nm, v / luminance) for nm, v in value[1]])
    return value


def rotation(angle, axis):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def shape(kind, p, state, folder):
    made, ctm = Shape(state["material"], state["emission"]), state["ctm"]
    if kind == "sphere":
        made.center, made.radius = ctm[:3, 3], p["radius"]
        return made
    if kind == "plymesh":
        assert np.array_equal(ctm, np.eye(4)), "meshes with files stand where the file has them"
        made.file = folder / p["filename"]
        return made
    made.positions = p["P"].reshape(-1, 3) @ ctm[:3, :3].T + ctm[:3, 3]
    if kind == "trianglemesh":
        made.triangles = p["indices"].reshape(-1, 3)
        made.uvs = p["uv"].reshape(-1, 2) if "uv" in p else None
    elif kind == "bilinearmesh":
        # Flat in all of the scenes: two triangles.
        made.triangles = np.array([[0, 1, 3], [0, 3, 2]])
        made.uvs = np.array(p.get("uv", [0, 0, 1, 0, 0, 1, 1, 1]), float).reshape(-1, 2)
    else:
        raise ValueError(f"the twins know no shape {kind}")
    return made
