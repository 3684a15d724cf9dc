"""Runs inside Blender: imports a glTF, replaces its materials by exact ones, renders it with Cycles to a 32-bit EXR.

  blender -b --factory-startup -P blender_scene.py -- SCENE.gltf OUT-SEED.exr [--size 480x270] [--samples 64] ...

Prints one line `CYCLES {json}` for the first picture. A first render of one sample gives build_s (copying the scene, acceleration structure,
one sample); render_s is the render call with all samples less that, so that it is the rendering alone.
"""
import argparse
import json
import math
import os
import struct
import sys
import tempfile
import time
import urllib.parse

import numpy as np

for alias, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
    if alias not in np.__dict__:   # the importer of Blender 3.4 names aliases that numpy 1.24 dropped
        setattr(np, alias, kind)

import bmesh  # noqa: E402
import bpy  # noqa: E402

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import blender_materials  # noqa: E402


def arguments():
    p = argparse.ArgumentParser(prog="blender_scene.py")
    p.add_argument("scene")
    p.add_argument("out")
    p.add_argument("--size", default="480x270")
    p.add_argument("--samples", type=int, default=64)
    p.add_argument("--camera", default="")
    p.add_argument("--seeds", default="0", help="0,1,...: a picture each; SEED in OUT stands for the number")
    p.add_argument("--pieces", type=int, default=256, help="triangles an emitter is divided into at least")
    p.add_argument("--depth", type=int, default=64)
    p.add_argument("--threads", type=int, default=2)
    return p.parse_args(sys.argv[sys.argv.index("--") + 1:])


def read_gltf(path):
    """The document, its binary chunk (or None), with every uri made absolute."""
    data = open(path, "rb").read()
    blob = None
    if data[:4] == b"glTF":
        at, doc = 12, None
        while at < len(data):
            size, kind = struct.unpack_from("<II", data, at)
            chunk = data[at + 8:at + 8 + size]
            if kind == 0x4E4F534A:
                doc = json.loads(chunk)
            elif kind == 0x004E4942:
                blob = chunk
            at += 8 + size
    else:
        doc = json.loads(data)
    folder = os.path.dirname(os.path.abspath(path))
    for item in doc.get("buffers", []) + doc.get("images", []):
        uri = item.get("uri", "")
        if uri and not uri.startswith("data:"):
            item["uri"] = urllib.parse.quote(os.path.join(folder, urllib.parse.unquote(uri)))
    return doc, blob


def image_files(doc, blob, temporary):
    """A file for each image of the document; embedded ones are written out."""
    files = []
    for i, image in enumerate(doc.get("images", [])):
        uri = image.get("uri", "")
        if uri and not uri.startswith("data:"):
            files.append(urllib.parse.unquote(uri))
            continue
        if uri:
            import base64
            data = base64.b64decode(uri.split(",", 1)[1])
        else:
            view = doc["bufferViews"][image["bufferView"]]
            buffer = doc["buffers"][view["buffer"]]
            source = blob if "uri" not in buffer else open(urllib.parse.unquote(buffer["uri"]), "rb").read()
            data = source[view.get("byteOffset", 0):view.get("byteOffset", 0) + view["byteLength"]]
        files.append(os.path.join(temporary, f"image{i}" + (".png" if data[:4] == b"\x89PNG" else ".jpg")))
        open(files[-1], "wb").write(data)
    return files


def geometry_only(doc, blob, temporary):
    """A copy whose materials are bare names m0, m1, ...: so the importer cannot fail on them."""
    bare = json.loads(json.dumps(doc))
    bare["materials"] = [{"name": f"m{i}", "doubleSided": True} for i in range(len(doc.get("materials", [])))]
    for key in ("images", "textures", "samplers", "animations"):
        bare.pop(key, None)
    keep = {"KHR_lights_punctual", "EXT_mesh_gpu_instancing"}
    for key in ("extensionsUsed", "extensionsRequired"):
        if key in bare:
            bare[key] = [e for e in bare[key] if e in keep]
            if not bare[key]:
                bare.pop(key)
    if blob is not None:
        path = os.path.join(temporary, "blob.bin")
        open(path, "wb").write(blob)
        bare["buffers"][0]["uri"] = urllib.parse.quote(path)
    path = os.path.join(temporary, "geometry.gltf")
    json.dump(bare, open(path, "w"))
    return path


def environment(doc, scene_path):
    """The description of the environment: settings.json beside the scene, else the scene's extras."""
    settings = os.path.join(os.path.dirname(os.path.abspath(scene_path)), "settings.json")
    if os.path.exists(settings):
        found = json.load(open(settings)).get("environment")
        if found:
            return found
    scene = doc["scenes"][doc.get("scene", 0)]
    return (scene.get("extras") or {}).get("environment")


def split_emitters(doc, pieces):
    """Divides the large faces of emitters: nearer to the plane of a triangle than its longest edge, Cycles 3.4 samples
    its solid angle, and returns up to 7 % too little light. The same surface in small triangles is sampled by area."""
    emissive = {f"m{i}" for i, m in enumerate(doc.get("materials", [])) if any(m.get("emissiveFactor", ()))}
    for mesh in bpy.data.meshes:
        slots = {i for i, m in enumerate(mesh.materials) if m is not None and m.name in emissive}
        bright = [p for p in mesh.polygons if p.material_index in slots]
        if not bright:
            continue
        cuts = round(math.sqrt(pieces / len(bright))) - 1
        if cuts < 1:
            continue
        form = bmesh.new()
        form.from_mesh(mesh)
        edges = {e for f in form.faces if f.material_index in slots for e in f.edges}
        bmesh.ops.subdivide_edges(form, edges=list(edges), cuts=cuts, use_grid_fill=True)
        form.to_mesh(mesh)
        form.free()


def set_world(env, folder):
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = nodes["Background"]
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    background.inputs["Strength"].default_value = 1
    if not env:
        return
    scale = float(env.get("scale", 1))
    if "radiance" in env:
        background.inputs["Color"].default_value = (*[scale * v for v in env["radiance"]], 1)
    elif "file" in env:
        texture = nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(os.path.join(folder, env["file"]))
        texture.image.colorspace_settings.name = "Linear"
        coordinate, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
        mapping.vector_type = "POINT"
        mapping.inputs["Rotation"].default_value = (0, 0, -math.radians(float(env.get("rotation", 0))))
        links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        links.new(texture.outputs["Color"], background.inputs["Color"])
        background.inputs["Strength"].default_value = scale
        world.cycles.sampling_method = "MANUAL"
        world.cycles.sample_map_resolution = max(texture.image.size[0], 256)


def set_camera(doc, name):
    """The named camera (node or camera name), else the first."""
    cameras = [o for o in bpy.context.scene.objects if o.type == "CAMERA"]
    nodes = [n for n in doc["nodes"] if "camera" in n]
    if not cameras:
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        bpy.context.scene.collection.objects.link(camera)
        bpy.context.scene.camera = camera
        return
    chosen = nodes[0]
    for n in nodes:
        if name and name in (n.get("name"), doc["cameras"][n["camera"]].get("name")):
            chosen = n
    label = chosen.get("name") or doc["cameras"][chosen["camera"]].get("name")
    camera = next((c for c in cameras if c.name == label or c.data.name == label), cameras[0])
    data, source = camera.data, doc["cameras"][chosen["camera"]]
    data.sensor_fit = "VERTICAL"
    if source["type"] == "perspective":
        data.type = "PERSP"
        data.angle_y = source["perspective"]["yfov"]
    else:
        data.type = "ORTHO"
        data.ortho_scale = 2 * source["orthographic"]["ymag"]
    data.clip_start, data.clip_end = 1e-4, 1e5
    data.shift_x = data.shift_y = 0
    data.dof.use_dof = False
    bpy.context.scene.camera = camera


def set_cycles(a):
    scene = bpy.context.scene
    width, height = (int(v) for v in a.size.split("x"))
    r, c = scene.render, scene.cycles
    r.engine = "CYCLES"
    r.resolution_x, r.resolution_y, r.resolution_percentage = width, height, 100
    r.pixel_aspect_x = r.pixel_aspect_y = 1
    r.threads_mode, r.threads = "FIXED", a.threads
    r.use_persistent_data = False   # with it, 3.4 keeps the first sample count as well
    r.film_transparent = False
    r.image_settings.file_format = "OPEN_EXR"
    r.image_settings.color_mode, r.image_settings.color_depth = "RGB", "32"
    r.image_settings.exr_codec = "ZIP"
    r.use_compositing = r.use_sequencer = False
    c.device, c.feature_set = "CPU", "SUPPORTED"
    c.use_adaptive_sampling = c.use_denoising = False
    c.use_auto_tile = False
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = c.volume_bounces = a.depth - 1
    c.transparent_max_bounces = 1024
    c.min_light_bounces = c.min_transparent_bounces = 0
    c.sample_clamp_direct = c.sample_clamp_indirect = 0
    c.blur_glossy, c.light_sampling_threshold = 0, 0
    c.caustics_reflective = c.caustics_refractive = True
    c.pixel_filter_type, c.filter_width = "BOX", 1.0
    c.use_fast_gi = False
    c.film_exposure = 1.0


def main():
    a = arguments()
    temporary = tempfile.mkdtemp(prefix="cycles-")
    doc, blob = read_gltf(a.scene)
    files = image_files(doc, blob, temporary)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=geometry_only(doc, blob, temporary), import_shading="NORMALS",
                              convert_lighting_mode="COMPAT")
    split_emitters(doc, a.pieces)
    blender_materials.replace_all(doc, files)
    for light in bpy.data.lights:
        light.shadow_soft_size = 0
        if light.type == "SUN":
            light.angle = 0
        light.cycles.use_multiple_importance_sampling = True
        light.cycles.max_bounces = 1024
    set_world(environment(doc, a.scene), os.path.dirname(os.path.abspath(a.scene)))
    set_camera(doc, a.camera)
    set_cycles(a)
    scene = bpy.context.scene
    for o in scene.objects:   # defaults to 0.1: moves the shadows of smooth surfaces
        o.cycles.shadow_terminator_geometry_offset = o.cycles.shadow_terminator_offset = 0
    seeds = [int(s) for s in a.seeds.split(",")]
    scene.render.filepath = os.path.abspath(a.out.replace("SEED", str(seeds[0])))
    scene.cycles.seed, scene.cycles.samples = seeds[0], 1
    start, cpu_start = time.perf_counter(), time.process_time()
    bpy.ops.render.render(write_still=False)
    build, cpu_build = time.perf_counter() - start, time.process_time() - cpu_start
    scene.cycles.samples = a.samples
    start, cpu_start = time.perf_counter(), time.process_time()
    bpy.ops.render.render(write_still=True)
    whole, cpu_whole = time.perf_counter() - start, time.process_time() - cpu_start
    seconds = max(whole - build, 1e-3)
    width, height = scene.render.resolution_x, scene.render.resolution_y
    print("CYCLES " + json.dumps({
        "samples": a.samples, "size": [width, height], "threads": a.threads, "build_s": round(build, 3),
        "call_s": round(whole, 3), "render_s": round(seconds, 3),
        "cpu_s": round(max(cpu_whole - cpu_build, 1e-3), 3),
        "samples_per_s": round((a.samples - 1) * width * height / seconds, 1)}), flush=True)
    for seed in seeds[1:]:
        scene.cycles.seed = seed
        scene.render.filepath = os.path.abspath(a.out.replace("SEED", str(seed)))
        bpy.ops.render.render(write_still=True)


try:
    main()
except Exception:
    import traceback
    traceback.print_exc()
    sys.stdout.flush()
    os._exit(1)
