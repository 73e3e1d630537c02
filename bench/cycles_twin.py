"""Renders a scene's twin with Blender's Cycles: `cycles_twin.py cycles SCENE THREADS SAMPLES`, then see worker.py.

Path tracing without denoising, adaptive sampling, clamping, or filtered caustics. Spheres and parallelograms of light are
lamps, which Cycles samples best; the camera does not see lamps, so each has a mesh in its place that nothing else sees.
"""

import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

import color
import meshes
import pbrt
import worker

scene_path, threads, samples = sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
scene, folder = pbrt.read(scene_path), tempfile.TemporaryDirectory()

# Complex indices of refraction of metals in RGB, from the measured spectra.
METALS = {
    "Cu": ((0.200, 0.924, 1.102), (3.912, 2.452, 2.142)),
    "Ag": ((0.155, 0.117, 0.138), (4.828, 3.122, 2.147)),
    "Al": ((1.657, 0.880, 0.521), (9.224, 6.270, 4.837)),
    "Au": ((0.143, 0.375, 1.442), (3.983, 2.386, 1.603)),
}


def rgb(value, of_spectrum=color.reflectance_of):
    return value[1] if value[0] == "rgb" else of_spectrum(value[1]).tolist()


def nodes_of(owner):
    owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def reflectance(tree, value, socket, change=lambda v: v):
    """Connects a colour or a texture."""
    if value[0] != "checks":
        socket.default_value = (*change(np.array(rgb(value))), 1)
        return
    _, u, v, first, second = value
    coordinates, scale = tree.nodes.new("ShaderNodeUVMap"), tree.nodes.new("ShaderNodeVectorMath")
    checks = tree.nodes.new("ShaderNodeTexChecker")
    scale.operation = "MULTIPLY"
    scale.inputs[1].default_value = (u, v, 0)
    checks.inputs["Scale"].default_value = 1
    # Its first colour is where the sum of the cells is odd.
    checks.inputs["Color1"].default_value = (*rgb(second), 1)
    checks.inputs["Color2"].default_value = (*rgb(first), 1)
    tree.links.new(coordinates.outputs[0], scale.inputs[0])
    tree.links.new(scale.outputs[0], checks.inputs["Vector"])
    tree.links.new(checks.outputs["Color"], socket)


def material(shape):
    made = bpy.data.materials.new("material")
    tree, given = nodes_of(made), shape.material
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    kind = given["kind"]
    if shape.emission:
        # One side emits, the other is black.
        surface = tree.nodes.new("ShaderNodeMixShader")
        geometry, emission = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*rgb(shape.emission, color.rgb_of), 1)
        emission.inputs["Strength"].default_value = 1
        tree.links.new(geometry.outputs["Backfacing"], surface.inputs[0])
        tree.links.new(emission.outputs[0], surface.inputs[1])
        made.cycles.emission_sampling = "FRONT"
    elif kind == "diffuse":
        surface = tree.nodes.new("ShaderNodeBsdfDiffuse")
        reflectance(tree, given["reflectance"], surface.inputs["Color"])
    elif kind == "dielectric":
        surface = tree.nodes.new("ShaderNodeBsdfGlass")
        surface.distribution = "GGX"
        surface.inputs["Color"].default_value = (1, 1, 1, 1)
        surface.inputs["Roughness"].default_value = np.sqrt(given["roughness"])
        surface.inputs["IOR"].default_value = given["eta"]
    elif kind == "conductor":
        surface = tree.nodes.new("ShaderNodeBsdfMetallic")
        surface.fresnel_type, surface.distribution = "PHYSICAL_CONDUCTOR", "GGX"
        eta, k = METALS[given["eta"][1].split("-")[1]]
        surface.inputs["IOR"].default_value, surface.inputs["Extinction"].default_value = eta, k
        u, v = (given.get(name, given.get("roughness")) for name in ("uroughness", "vroughness"))
        # Cycles: roughness² = sqrt(u v), and the ratio of the axes is 1 − 0.9 anisotropy.
        surface.inputs["Roughness"].default_value = (u * v) ** 0.25
        surface.inputs["Anisotropy"].default_value = (1 - min(u, v) / max(u, v)) / 0.9
        if u != v:
            tangent = tree.nodes.new("ShaderNodeTangent")
            tangent.direction_type = "UV_MAP"
            tree.links.new(tangent.outputs[0], surface.inputs["Tangent"])
    elif kind == "coateddiffuse":
        surface = tree.nodes.new("ShaderNodeBsdfPrincipled")
        surface.distribution = "GGX"
        surface.inputs["Roughness"].default_value = np.sqrt(given["roughness"])
        surface.inputs["IOR"].default_value = 1.5
        # Light is reflected inside the coat, 59.6 % each time, before it leaves: Cycles' coat does not say so by itself.
        inside = lambda a: a * (1 - 0.596) / (1 - a * 0.596)
        reflectance(tree, given["reflectance"], surface.inputs["Base Color"], inside)
    else:
        raise ValueError(kind)
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return made


def place(data, matrix=Matrix()):
    made = bpy.data.objects.new("object", data)
    made.matrix_world = matrix
    bpy.context.scene.collection.objects.link(made)
    return made


def lamp(kind, shape, power):
    """A lamp of the shape's radiance; `power` is for radiance one, in watts."""
    made = bpy.data.lights.new("lamp", kind)
    radiance = np.array(rgb(shape.emission, color.rgb_of))
    made.color, made.energy = radiance / radiance.max(), radiance.max() * power
    return made


def add_lamp(shape):
    """Adds a lamp where the shape can be one, and says whether."""
    if shape.is_sphere:
        made = lamp("POINT", shape, 4 * np.pi**2 * shape.radius**2)
        made.shadow_soft_size, made.use_soft_falloff = shape.radius, False
        place(made, Matrix.Translation(shape.center))
        return True
    p = shape.positions
    if p is None or len(p) != 4 or not np.allclose(p[0] + p[2], p[1] + p[3]):
        return False
    x, y = p[1] - p[0], p[3] - p[0]
    normal = np.cross(x, y)
    made = lamp("AREA", shape, np.pi * np.linalg.norm(normal))
    made.shape, made.size, made.size_y = "RECTANGLE", np.linalg.norm(x), np.linalg.norm(y)
    # Lamps shine along −z.
    axes = [x / np.linalg.norm(x), -y / np.linalg.norm(y), -normal / np.linalg.norm(normal)]
    matrix = Matrix([[*row, at] for row, at in zip(np.array(axes).T, p.mean(0))] + [[0, 0, 0, 1]])
    place(made, matrix)
    return True


def add(shape):
    is_lamp = shape.emission is not None and add_lamp(shape)
    mesh = bpy.data.meshes.new("mesh")
    matrix = Matrix()
    if shape.is_sphere:
        import bmesh

        made = bmesh.new()
        bmesh.ops.create_icosphere(made, subdivisions=7, radius=shape.radius)
        made.to_mesh(mesh)
        mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
        matrix = Matrix.Translation(shape.center)
    else:
        positions, triangles = (shape.positions, shape.triangles) if shape.file is None else meshes.read_ply(shape.file)
        mesh.vertices.add(len(positions))
        mesh.vertices.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
        mesh.loops.add(3 * len(triangles))
        mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles, np.int32).ravel())
        mesh.polygons.add(len(triangles))
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
        if shape.uvs is not None:
            layer = mesh.uv_layers.new()
            layer.data.foreach_set("uv", shape.uvs[shape.triangles].astype(np.float32).ravel())
        mesh.update(calc_edges=True)
        mesh.polygons.foreach_set("use_smooth", np.zeros(len(triangles), bool))
    mesh.materials.append(material(shape))
    made = place(mesh, matrix)
    if is_lamp:
        mesh.materials[0].cycles.emission_sampling = "NONE"
        made.visible_diffuse = made.visible_glossy = made.visible_transmission = made.visible_shadow = False


def add_camera():
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL" if scene.height <= scene.width else "HORIZONTAL"
    data.sensor_width = data.sensor_height = 100
    data.lens = 50 / np.tan(np.radians(scene.fov) / 2)
    data.clip_start, data.clip_end = 1e-3, 1e6
    if scene.lens_radius:
        data.dof.use_dof, data.dof.focus_distance = True, scene.focal_distance
        data.dof.aperture_fstop = data.lens * 1e-3 / (2 * scene.lens_radius)
    eye, target, up = (Vector(v) for v in (scene.eye, scene.target, scene.up))
    back = (eye - target).normalized()
    right = up.cross(back).normalized()
    matrix = Matrix([right, back.cross(right), back]).transposed().to_4x4()
    bpy.context.scene.camera = place(data, Matrix.Translation(eye) @ matrix)


def load():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blend = bpy.context.scene
    world = bpy.data.worlds.new("world")
    blend.world = world
    tree = nodes_of(world)
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value = (*(rgb(scene.sky, color.rgb_of) if scene.sky else (0, 0, 0)), 1)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    for shape in scene.shapes:
        add(shape)
    add_camera()

    render, cycles = blend.render, blend.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = scene.width, scene.height, 100
    render.threads_mode, render.threads = "FIXED", threads
    # A second render keeps what the first has made: the hierarchy, and the scene in Cycles' own form.
    render.use_persistent_data = True
    render.use_compositing = render.use_sequencer = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath, render.use_file_extension = str(Path(folder.name) / "picture.exr"), False
    cycles.device, cycles.samples = "CPU", samples
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    # Cycles counts the scattering after the first.
    for bounces in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, f"{bounces}_bounces", scene.max_depth - 1)


def render(seed):
    bpy.context.scene.cycles.seed = seed
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(bpy.context.scene.render.filepath, check_existing=False)
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    # Blender has the last row first; and its picture of pbrt's left-handed space is a mirror image.
    return pixels.reshape(scene.height, scene.width, -1)[::-1, ::-1, :3]


worker.serve(load, render)
