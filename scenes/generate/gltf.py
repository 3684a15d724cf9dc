"""Writes glTF 2.0: a small builder used by every generator in this folder.

Python 3 and numpy only. Running a generator twice gives the same bytes: no clock, no hash order, seeds fixed,
coordinates rounded to 10 micrometres before they are stored.
"""
import json
import os
import struct
import zlib

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.dirname(HERE)

FLOAT, U16, U32 = 5126, 5123, 5125


class Mesh:
    """Triangles with one normal and one uv a vertex; the unit of building. Positions in metres, Y up."""

    def __init__(self, p, n, uv, t):
        self.p = np.asarray(p, float).reshape(-1, 3)
        self.n = np.asarray(n, float).reshape(-1, 3)
        self.uv = np.zeros((len(self.p), 2)) if uv is None else np.asarray(uv, float).reshape(-1, 2)
        self.t = np.asarray(t, np.int64).reshape(-1, 3)

    def moved(self, matrix):
        """A copy under a 4x4 matrix (rotation, uniform or axis scale, mirror)."""
        m = np.asarray(matrix, float)
        inv_t = np.linalg.inv(m[:3, :3]).T
        n = self.n @ inv_t.T
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-20)
        t = self.t[:, ::-1] if np.linalg.det(m[:3, :3]) < 0 else self.t
        return Mesh(self.p @ m[:3, :3].T + m[:3, 3], n, self.uv, t)

    def flipped(self):
        """The same surface seen from the other side."""
        return Mesh(self.p, -self.n, self.uv, self.t[:, ::-1])

    def with_uv(self, uv):
        return Mesh(self.p, self.n, uv, self.t)


def join(meshes):
    """One mesh of many."""
    p, n, uv, t, base = [], [], [], [], 0
    for m in meshes:
        p.append(m.p), n.append(m.n), uv.append(m.uv), t.append(m.t + base)
        base += len(m.p)
    return Mesh(np.concatenate(p), np.concatenate(n), np.concatenate(uv), np.concatenate(t))


def png(path, pixels):
    """Writes an 8-bit PNG: pixels is (h, w), (h, w, 3) or (h, w, 4), uint8. Row filters by least absolute sum."""
    a = np.asarray(pixels, np.uint8)
    if a.ndim == 2:
        a = a[:, :, None]
    h, w, c = a.shape
    raw = a.reshape(h, w * c).astype(np.int16)
    left = np.zeros_like(raw)
    left[:, c:] = raw[:, :-c]
    up = np.zeros_like(raw)
    up[1:] = raw[:-1]
    corner = np.zeros_like(raw)
    corner[1:, c:] = raw[:-1, :-c]
    guess = left + up - corner
    da, db, dc = abs(guess - left), abs(guess - up), abs(guess - corner)
    paeth = np.where((da <= db) & (da <= dc), left, np.where(db <= dc, up, corner))
    rows = np.stack([raw, raw - left, raw - up, raw - (left + up) // 2, raw - paeth]).astype(np.uint8)
    cost = np.abs(rows.astype(np.int8).astype(np.int32)).sum(axis=2)
    best = cost.argmin(axis=0)
    out = np.empty((h, 1 + w * c), np.uint8)
    out[:, 0] = best
    out[:, 1:] = rows[best, np.arange(h)]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", w, h, 8, {1: 0, 3: 2, 4: 6}[c], 0, 0, 0)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(out.tobytes(), 9)) +
                chunk(b"IEND", b""))


def hdr(path, rgb):
    """Writes a Radiance picture (RGBE, run-length encoded); rgb is (h, w, 3), linear, row 0 at the top."""
    a = np.maximum(np.asarray(rgb, float), 0)
    h, w, _ = a.shape
    top = a.max(axis=2)
    _, e = np.frexp(np.maximum(top, 1e-32))
    scale = np.where(top > 1e-32, 256.0 / np.exp2(e.astype(float)), 0)
    m = np.clip(np.floor(a * scale[:, :, None]), 0, 255).astype(np.uint8)
    ex = np.where(top > 1e-32, e + 128, 0).astype(np.uint8)
    out = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (h, w))
    for y in range(h):
        out += struct.pack(">BBH", 2, 2, w)
        for line in (m[y, :, 0], m[y, :, 1], m[y, :, 2], ex[y]):
            line, i = line.tobytes(), 0
            while i < w:
                run = 1
                while i + run < w and run < 127 and line[i + run] == line[i]:
                    run += 1
                if run >= 3:
                    out += bytes((128 + run, line[i]))
                    i += run
                    continue
                j = i + 1
                while j < w and j - i < 128 and not (j + 2 < w and line[j] == line[j + 1] == line[j + 2]):
                    j += 1
                out += bytes((j - i,)) + line[i:j]
                i = j
    with open(path, "wb") as f:
        f.write(out)


def _numbers(values, digits=6):
    """Rounded python floats, integers where they are whole."""
    out = []
    for v in np.asarray(values, float).ravel():
        v = round(float(v), digits)
        out.append(int(v) if v == int(v) else v)
    return out


class Scene:
    """Collects nodes, meshes and materials by name, then writes NAME/NAME.gltf, .bin and settings.json."""

    def __init__(self, name):
        self.name = name
        self.folder = os.path.join(SCENES, name)
        os.makedirs(self.folder, exist_ok=True)
        self.bin = bytearray()
        self.views, self.accessors, self.meshes, self.nodes = [], [], [], []
        self.materials, self.images, self.textures, self.lights, self.cameras = [], [], [], [], []
        self.used = set()
        self.material_ids, self.mesh_ids, self.geometry, self.triangles = {}, {}, {}, {}
        self.total = 0
        self.variant_names = []
        self.profiles = []
        self.extras = None

    # ---- materials -------------------------------------------------------------------------------------------------
    def texture(self, file):
        """Index of the texture of an image file in the scene's folder; repeats, linear."""
        if file not in self.images:
            self.images.append(file)
            self.textures.append({"sampler": 0, "source": len(self.images) - 1})
        return self.images.index(file)

    def texture_info(self, file, metres=None):
        info = {"index": self.texture(file)}
        if metres:
            scale = 1.0 / np.broadcast_to(metres, 2)
            info["extensions"] = {"KHR_texture_transform": {"scale": _numbers(scale, 6)}}
            self.used.add("KHR_texture_transform")
        return info

    def material(self, name, color=(0.8, 0.8, 0.8), rough=1.0, metal=0.0, lambert=False, emit=None, strength=1.0,
                 glass=None, thin=False, ior=None, double=False, maps=None, metres=None, through=None,
                 through_color=None, normal_scale=1.0, attenuation=None, specular=None, layers=None, relief=None,
                 diffuse_rough=None):
        """Adds a material once and returns its name.

        lambert: a pure Lambertian (KHR_materials_specular with factor 0). emit: emitted radiance per `strength`.
        glass: roughness of a refracting solid (or thin wall with thin=True). through: share of the diffuse light
        that passes (KHR_materials_diffuse_transmission). maps: {"color", "normal", "rough"} -> files;
        metres: size of one repeat of the maps where uv is in metres. layers: further extensions, such as
        {"clearcoat": {"clearcoatFactor": 1}}, without the prefix KHR_materials_. relief: (file of heights, metres of
        one repeat, metres from black to white, deep). diffuse_rough: roughness of the diffuse reflection, 0 to 1.
        """
        if name in self.material_ids:
            return name
        pbr = {"baseColorFactor": _numbers(list(color) + [1], 4), "metallicFactor": metal, "roughnessFactor": rough}
        m = {"name": name, "pbrMetallicRoughness": pbr}
        ext = {}
        if lambert or specular is not None:
            ext["KHR_materials_specular"] = {"specularFactor": 0 if lambert else specular}
        if ior:
            ext["KHR_materials_ior"] = {"ior": ior}
        if glass is not None:
            pbr["roughnessFactor"] = glass
            ext["KHR_materials_ior"] = {"ior": ior or 1.5}
            ext["KHR_materials_transmission"] = {"transmissionFactor": 1}
            if not thin:
                ext["KHR_materials_volume"] = {"thicknessFactor": 1}
                if attenuation:
                    ext["KHR_materials_volume"].update(
                        {"attenuationColor": _numbers(attenuation[0]), "attenuationDistance": attenuation[1]})
        if through is not None:
            ext["KHR_materials_diffuse_transmission"] = {
                "diffuseTransmissionFactor": through, "diffuseTransmissionColorFactor": _numbers(through_color)}
            if maps and "through" in maps:
                ext["KHR_materials_diffuse_transmission"]["diffuseTransmissionColorTexture"] = self.texture_info(
                    maps["through"], metres)
        if emit is not None:
            m["emissiveFactor"] = _numbers(emit)
            if strength != 1:
                ext["KHR_materials_emissive_strength"] = {"emissiveStrength": _numbers([strength])[0]}
        if maps:
            if "color" in maps:
                pbr["baseColorTexture"] = self.texture_info(maps["color"], metres)
            if "rough" in maps:
                pbr["metallicRoughnessTexture"] = self.texture_info(maps["rough"], metres)
            if "normal" in maps:
                m["normalTexture"] = self.texture_info(maps["normal"], metres)
                if normal_scale != 1:
                    m["normalTexture"]["scale"] = normal_scale
        for key, values in (layers or {}).items():
            ext["KHR_materials_" + key] = values
        if diffuse_rough is not None:
            ext["EXT_materials_diffuse_roughness"] = {"diffuseRoughnessFactor": diffuse_rough}
        if relief:
            file, size, height, deep = relief
            m["extras"] = {"lucerna": {"height": {"texture": self.texture_info(file, size), "height": height,
                                                  "deep": deep}}}
        if double:
            m["doubleSided"] = True
        if ext:
            m["extensions"] = ext
            self.used.update(ext)
        self.material_ids[name] = len(self.materials)
        self.materials.append(m)
        return name

    # ---- geometry --------------------------------------------------------------------------------------------------
    def _view(self, array, target, stride=None):
        while len(self.bin) % 4:
            self.bin.append(0)
        data = array.tobytes()
        self.views.append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data), "target": target})
        self.bin += data
        return len(self.views) - 1

    def _accessor(self, array, kind, component, target, bounds=False):
        a = {"bufferView": self._view(array, target), "componentType": component,
             "count": int(array.shape[0]), "type": kind}
        if bounds:
            a["min"], a["max"] = [float(v) for v in array.min(axis=0)], [float(v) for v in array.max(axis=0)]
        self.accessors.append(a)
        return len(self.accessors) - 1

    @staticmethod
    def _unit_normals(p, n, t):
        """Normals, with those of length 0 replaced by the mean of their triangles' (up, without any)."""
        zero = np.linalg.norm(n, axis=1) < 0.5
        if not zero.any():
            return n
        n = n.copy()
        faces = np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]])
        sums = np.zeros_like(p)
        for k in range(3):
            np.add.at(sums, t[:, k], faces)
        length = np.linalg.norm(sums, axis=1, keepdims=True)
        n[zero] = np.where(length > 1e-12, sums / np.maximum(length, 1e-12), [0, 1, 0])[zero]
        return n

    def _geometry(self, mesh, uv):
        key = (id(mesh), uv)
        if key not in self.geometry:
            p = np.round(mesh.p, 5)
            n = mesh.n / np.maximum(np.linalg.norm(mesh.n, axis=1, keepdims=True), 1e-20)
            rows = np.concatenate([p, np.round(n, 4), np.round(mesh.uv, 4) if uv else mesh.uv * 0], axis=1)
            _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
            order = np.argsort(first, kind="stable")   # keep the order of first appearance
            rank = np.empty_like(order)
            rank[order] = np.arange(len(order))
            keep, t = first[order], rank[inverse][mesh.t]
            q = p[keep]
            area = np.linalg.norm(np.cross(q[t[:, 1]] - q[t[:, 0]], q[t[:, 2]] - q[t[:, 0]]), axis=1)
            t = t[area > 1e-9]
            n = self._unit_normals(q, n[keep], t)
            attributes = {"POSITION": self._accessor(q.astype("<f4"), "VEC3", FLOAT, 34962, True),
                          "NORMAL": self._accessor(n.astype("<f4"), "VEC3", FLOAT, 34962)}
            if uv:
                attributes["TEXCOORD_0"] = self._accessor(mesh.uv[keep].astype("<f4"), "VEC2", FLOAT, 34962)
            small = len(keep) < 65535
            index = t.ravel().astype("<u2" if small else "<u4")
            indices = self._accessor(index, "SCALAR", U16 if small else U32, 34963)
            self.geometry[key] = (attributes, indices, len(t), mesh)
        return self.geometry[key]

    def mesh(self, name, parts):
        """Adds a mesh of (Mesh, material name) parts. The same Mesh object under other materials shares its bytes."""
        primitives, count = [], 0
        for mesh, material in parts:
            m = self.materials[self.material_ids[material]]
            textured = any(key in json.dumps(m) for key in ('"index"', 'KHR_materials_anisotropy'))
            attributes, indices, n, _ = self._geometry(mesh, textured)
            primitives.append({"attributes": attributes, "indices": indices, "material": self.material_ids[material]})
            count += n
        self.mesh_ids[name] = len(self.meshes)
        self.triangles[name] = count
        self.meshes.append({"name": name, "primitives": primitives})
        return name

    def variants(self, mesh, materials):
        """Gives the first part of a mesh another material in each variant: {variant: material name}."""
        self.variant_names += [v for v in materials if v not in self.variant_names]
        self.meshes[self.mesh_ids[mesh]]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": [
            {"material": self.material_ids[m], "variants": [self.variant_names.index(v)]} for v, m in materials.items()]}}
        self.used.add("KHR_materials_variants")

    def place(self, mesh, at=(0, 0, 0), yaw=0.0, matrix=None, scale=None, name=None):
        """Adds a node showing a mesh: at in metres, yaw in degrees (counter-clockwise seen from above)."""
        node = {"name": name or mesh, "mesh": self.mesh_ids[mesh]}
        if matrix is not None:
            node["matrix"] = _numbers(np.asarray(matrix, float).T, 7)
        else:
            if any(at):
                node["translation"] = _numbers(at, 5)
            if yaw:
                half = np.radians(yaw) / 2
                node["rotation"] = _numbers([0, np.sin(half), 0, np.cos(half)], 7)
            if scale is not None:
                node["scale"] = _numbers(np.broadcast_to(scale, 3))
        self.nodes.append(node)
        self.total += self.triangles[mesh]

    def portal(self, name, mesh):
        """Marks a rectangle whose front faces the room as an opening through which the sky lights it."""
        attributes, indices, _, _ = self._geometry(mesh, False)
        self.meshes.append({"name": name, "primitives": [{"attributes": attributes, "indices": indices}]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1, "extras": {"portal": True}})

    # ---- cameras and lights ----------------------------------------------------------------------------------------
    @staticmethod
    def look(eye, target, up=(0, 1, 0)):
        """Camera-to-world matrix: looks down -Z."""
        eye, target, up = (np.asarray(v, float) for v in (eye, target, up))
        z = eye - target
        z /= np.linalg.norm(z)
        x = np.cross(up, z)
        x /= np.linalg.norm(x)
        m = np.eye(4)
        m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = x, np.cross(z, x), z, eye
        return m

    def camera(self, name, eye, target, yfov=None, ortho=None, up=(0, 1, 0), aspect=None):
        """yfov in degrees, or ortho = (half width, half height) in metres."""
        if ortho:
            camera = {"name": name, "type": "orthographic",
                      "orthographic": {"xmag": ortho[0], "ymag": ortho[1], "znear": 0.001, "zfar": 1000}}
        else:
            camera = {"name": name, "type": "perspective",
                      "perspective": {"yfov": round(float(np.radians(yfov)), 7), "znear": 0.01, "zfar": 1000}}
            if aspect:
                camera["perspective"]["aspectRatio"] = round(aspect, 7)
        self.cameras.append(camera)
        self.nodes.append({"name": name, "camera": len(self.cameras) - 1,
                           "matrix": _numbers(self.look(eye, target, up).T, 7)})

    def sun(self, name, direction, color, irradiance):
        """A directional light shining along `direction`; irradiance on a facing plane = color * irradiance."""
        d = np.asarray(direction, float)
        self.lights.append({"name": name, "type": "directional", "color": _numbers(color, 4),
                            "intensity": irradiance})
        m = self.look((0, 0, 0), d, (0, 1, 0) if abs(d[1]) < 0.999 * np.linalg.norm(d) else (0, 0, 1))
        self.nodes.append({"name": name, "matrix": _numbers(m.T, 7),
                           "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}}})
        self.used.add("KHR_lights_punctual")

    def spot(self, name, at, direction, color, candela, inner, outer):
        """A lamp at `at` shining along `direction`: color * candela along its axis, and as much up to `inner` degrees from it,
        none from `outer` degrees on."""
        self.lights.append({"name": name, "type": "spot", "color": _numbers(color, 4), "intensity": candela,
                            "spot": {"innerConeAngle": round(float(np.radians(inner)), 7),
                                     "outerConeAngle": round(float(np.radians(outer)), 7)}})
        at, d = np.asarray(at, float), np.asarray(direction, float)
        m = self.look(at, at + d, (0, 1, 0) if abs(d[1]) < 0.999 * np.linalg.norm(d) else (0, 0, 1))
        self.nodes.append({"name": name, "matrix": _numbers(m.T, 7),
                           "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}}})
        self.used.add("KHR_lights_punctual")

    def point_lamp(self, name, at, color, candela):
        self.lights.append({"name": name, "type": "point", "color": _numbers(color, 4), "intensity": candela})
        self.nodes.append({"name": name, "translation": _numbers(at, 5),
                           "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}}})
        self.used.add("KHR_lights_punctual")

    def shaped(self, name, at, direction, color, candela, shape, up=(0, 1, 0)):
        """A lamp with a shape, {"shape": "rectangle", "width": ...} (scenes/README.md), that shines along `direction`, its
        width across `up`. color * candela in front of it."""
        flat = shape["shape"] in ("rectangle", "disk")
        light = {"name": name, "type": "spot" if flat else "point", "color": _numbers(color, 4), "intensity": candela,
                 "extras": {"lucerna": shape}}
        if flat:
            light["spot"] = {"innerConeAngle": 0, "outerConeAngle": round(float(np.pi / 2), 7)}
        self.lights.append(light)
        at, d = np.asarray(at, float), np.asarray(direction, float)
        self.nodes.append({"name": name, "matrix": _numbers(self.look(at, at + d, up).T, 7),
                           "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}}})
        self.used.add("KHR_lights_punctual")

    def fixture(self, name, at, direction, file, multiplier, color=(1, 1, 1)):
        """A lamp of the measured distribution in an LM-63 file of the scene's folder; multiplier: of its candela."""
        if file not in self.profiles:
            self.profiles.append(file)
        at, d = np.asarray(at, float), np.asarray(direction, float)
        m = self.look(at, at + d, (0, 1, 0) if abs(d[1]) < 0.999 * np.linalg.norm(d) else (0, 0, -1))
        self.nodes.append({"name": name, "matrix": _numbers(m.T, 7),
                           "extensions": {"EXT_lights_ies": {"light": self.profiles.index(file), "multiplier": multiplier,
                                                             "color": _numbers(color, 4)}}})
        self.used.add("EXT_lights_ies")

    # ---- output ----------------------------------------------------------------------------------------------------
    def write(self, about, settings=None):
        doc = {"asset": {"version": "2.0", "generator": "lucerna scenes/generate"}}
        if self.used:
            doc["extensionsUsed"] = sorted(self.used)
        if self.lights:
            doc["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        if self.profiles:
            doc.setdefault("extensions", {})["EXT_lights_ies"] = {"lights": [{"uri": f} for f in self.profiles]}
        if self.variant_names:
            doc.setdefault("extensions", {})["KHR_materials_variants"] = {
                "variants": [{"name": v} for v in self.variant_names]}
        scene = {"name": self.name, "nodes": list(range(len(self.nodes)))}
        if self.extras:
            scene["extras"] = self.extras
        doc.update({"scene": 0, "scenes": [scene], "nodes": self.nodes, "meshes": self.meshes,
                    "materials": self.materials, "cameras": self.cameras})
        if self.images:
            doc["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
            doc["textures"] = self.textures
            doc["images"] = [{"uri": f, "name": os.path.splitext(f)[0]} for f in self.images]
        while len(self.bin) % 4:
            self.bin.append(0)
        doc["accessors"], doc["bufferViews"] = self.accessors, self.views
        doc["buffers"] = [{"uri": self.name + ".bin", "byteLength": len(self.bin)}]
        with open(os.path.join(self.folder, self.name + ".bin"), "wb") as f:
            f.write(self.bin)
        with open(os.path.join(self.folder, self.name + ".gltf"), "w") as f:
            f.write(_layout(doc))
        with open(os.path.join(self.folder, "settings.json"), "w") as f:
            json.dump({"about": about, **(settings or {})}, f, indent=2)
            f.write("\n")
        print(f"{self.name}: {self.total} triangles in {len(self.nodes)} nodes, bin {len(self.bin)} bytes")


def _layout(doc):
    """JSON with one entry of each list a line: small, and still readable in a diff."""
    lines = []
    for key, value in doc.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            body = ",\n".join("    " + json.dumps(v) for v in value)
            lines.append(f"  {json.dumps(key)}: [\n{body}\n  ]")
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
