"""Renders a scene's twin with Mitsuba: `mitsuba_twin.py VARIANT SCENE THREADS SAMPLES`, then see worker.py."""

import sys
import tempfile
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

import meshes
import pbrt
import worker

variant, scene_path, threads, samples = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
dr.set_thread_count(threads)
mi.set_variant(variant)
scene, folder = pbrt.read(scene_path), tempfile.TemporaryDirectory()


def color(value):
    kind, *values = value
    if kind == "rgb":
        return {"type": "rgb", "value": values[0]}
    if kind == "spectrum":
        return {"type": "spectrum", "value": [(float(a), float(b)) for a, b in values[0]]}
    u, v, first, second = values
    # One period of Mitsuba's checkerboard has two checks.
    to_uv = mi.ScalarTransform4f().scale([u / 2, v / 2, 1])
    return {"type": "checkerboard", "color0": color(first), "color1": color(second), "to_uv": to_uv}


def bsdf(material):
    kind = material["kind"]
    if kind == "diffuse":
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color(material["reflectance"])}}
    if kind == "coateddiffuse":
        reflectance = color(material["reflectance"])
        alpha = material["roughness"]
        return {"type": "roughplastic", "distribution": "ggx", "alpha": alpha, "int_ior": 1.5,
                "diffuse_reflectance": reflectance, "nonlinear": True}
    if kind == "dielectric":
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": material["roughness"], "int_ior": material["eta"]}
    if kind == "conductor":
        metal = material["eta"][1].split("-")[1]
        u, v = (material.get(k, material.get("roughness")) for k in ("uroughness", "vroughness"))
        rough = {"type": "roughconductor", "material": metal, "distribution": "ggx", "alpha_u": u, "alpha_v": v}
        return {"type": "twosided", "bsdf": rough}
    raise ValueError(kind)


def shape(index, shape):
    made = {"bsdf": bsdf(shape.material)}
    if shape.emission:
        made["emitter"] = {"type": "area", "radiance": color(shape.emission)}
    if shape.is_sphere:
        return made | {"type": "sphere", "center": shape.center.tolist(), "radius": shape.radius}
    file = shape.file
    if file is None:
        file = Path(folder.name) / f"{index}.ply"
        meshes.write_ply(file, shape.positions, shape.triangles, shape.uvs)
    return made | {"type": "ply", "filename": str(file), "face_normals": True}


def load():
    global loaded
    width, height = scene.width, scene.height
    camera = {
        "type": "thinlens" if scene.lens_radius else "perspective", "fov": scene.fov, "fov_axis": "smaller",
        "to_world": mi.ScalarTransform4f().look_at(*(v.tolist() for v in (scene.eye, scene.target, scene.up))),
        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
        "sampler": {"type": "independent", "sample_count": samples},
    }
    if scene.lens_radius:
        camera |= {"aperture_radius": scene.lens_radius, "focus_distance": scene.focal_distance}
    # pbrt counts the scattering, Mitsuba the edges of the path.
    description = {"type": "scene", "integrator": {"type": "path", "max_depth": scene.max_depth + 1}, "sensor": camera}
    if scene.sky:
        description["sky"] = {"type": "constant", "radiance": color(scene.sky)}
    description |= {f"shape{i}": shape(i, s) for i, s in enumerate(scene.shapes)}
    loaded = mi.load_dict(description)


def render(seed):
    # Mitsuba's camera looks through the picture from the other side.
    return np.array(mi.render(loaded, spp=samples, seed=seed))[:, ::-1]


worker.serve(load, render)
