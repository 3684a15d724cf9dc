"""Runs inside Blender: node trees equivalent to the glTF material in Lucerna (shaders/lib/bsdf.glsl).

Exact: Lambert, sharp and rough solid glass, smooth thin glass, smooth metals and coats, emission, alpha, textures.
Within about 1 % of the lobe, and exact in what a direction of view sees of uniform light:
  - rough lobes with Schlick's factor: Blender's closure has another Fresnel curve between the same ends; its weight is
    the ratio of the two directional albedos (microfacet.py);
  - the diffuse lobe under a coat, (1-E(o)) (1-E(i)) / (1-E_avg): the factor of o from a table, that of i as a
    sum of Lambert and Principled's diffuse term at roughness 0, (1 - F/2)(1 - F/2) with Schlick's weight F: within 1 %
    from roughness 0.35 up, 5 % too much at grazing angles and 2 % too little elsewhere for a smooth coat.
Not: rough thin glass (Cycles has no such closure), textures of KHR_materials_specular, normal maps near the terminator
(Cycles darkens there).
"""
import math

import bpy
import microfacet
import numpy as np


class Tree:
    """A material's node tree with short ways to add nodes; a value is a number, a colour or a socket."""

    def __init__(self, material):
        material.use_nodes = True
        self.nodes, self.links = material.node_tree.nodes, material.node_tree.links
        self.nodes.clear()

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.links.new(value, socket)
        elif value is not None:
            color = isinstance(value, (tuple, list)) and socket.type == "RGBA"
            socket.default_value = (*value[:3], 1) if color else value

    def node(self, kind, inputs=None, **attributes):
        n = self.nodes.new("ShaderNode" + kind)
        for k, v in attributes.items():
            setattr(n, k, v)
        for k, v in (inputs or {}).items():
            self.set(n.inputs[k], v)
        return n

    def math(self, operation, a, b=0.0):
        if not isinstance(a, bpy.types.NodeSocket) and not isinstance(b, bpy.types.NodeSocket):
            return {"MULTIPLY": lambda: a * b, "SUBTRACT": lambda: a - b, "ADD": lambda: a + b}[operation]()
        return self.node("Math", {0: a, 1: b}, operation=operation).outputs[0]

    def times(self, a, b):
        """Product of two colours."""
        if not isinstance(a, bpy.types.NodeSocket) and not isinstance(b, bpy.types.NodeSocket):
            return tuple(x * y for x, y in zip(a, b))
        for x, y in ((a, b), (b, a)):
            if not isinstance(x, bpy.types.NodeSocket) and all(v == 1 for v in x[:3]):
                return y
        return self.node("MixRGB", {"Fac": 1.0, "Color1": a, "Color2": b}, blend_type="MULTIPLY").outputs[0]

    def blend(self, factor, a, b):
        """Closure a where factor is 0, b where it is 1."""
        if not isinstance(factor, bpy.types.NodeSocket) and factor in (0, 1):
            return b if factor else a
        if a is None and b is None:
            return None
        n = self.node("MixShader", {0: factor})
        if a is not None:
            self.links.new(a, n.inputs[1])
        if b is not None:
            self.links.new(b, n.inputs[2])
        return n.outputs[0]


class Material:
    def __init__(self, doc, files, index, colored):
        self.doc, self.files, self.colored = doc, files, colored
        self.m = doc["materials"][index]
        self.ext = self.m.get("extensions", {})
        self.tree = Tree(bpy.data.materials[f"m{index}"])
        self.cache = {}

    def texture(self, info, color):
        """The texture node of a textureInfo, or None."""
        if not info:
            return None
        key = (str(info.get("index")), str(info.get("extensions")), info.get("texCoord", 0), color)
        if key in self.cache:
            return self.cache[key]
        t = self.tree
        texture = self.doc["textures"][info["index"]]
        sampler = self.doc["samplers"][texture["sampler"]] if "sampler" in texture else {}
        transform = info.get("extensions", {}).get("KHR_texture_transform", {})
        uv_set = transform.get("texCoord", info.get("texCoord", 0))
        vector = t.node("UVMap", uv_map="UVMap" if uv_set == 0 else f"UVMap.{uv_set:03d}").outputs[0]
        sx, sy = transform.get("scale", (1, 1))
        ox, oy = transform.get("offset", (0, 0))
        c, s = math.cos(transform.get("rotation", 0)), math.sin(transform.get("rotation", 0))
        # glTF: u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy; Blender's v is 1 - v
        a, b, d, e = c * sx, s * sy, -s * sx, c * sy
        if s == 0 and (sx, sy, ox, oy) != (1, 1, 0, 0):
            vector = t.node("VectorMath", {0: vector, 1: (a, e, 0), 2: (ox, 1 - e - oy, 0)},
                            operation="MULTIPLY_ADD").outputs[0]
        elif s != 0:
            x = t.node("VectorMath", {0: vector, 1: (a, -b, 0)}, operation="DOT_PRODUCT").outputs["Value"]
            y = t.node("VectorMath", {0: vector, 1: (-d, e, 0)}, operation="DOT_PRODUCT").outputs["Value"]
            vector = t.node("CombineXYZ", {0: t.math("ADD", x, b + ox), 1: t.math("ADD", y, 1 - d - e - oy)}).outputs[0]
        image = bpy.data.images.load(self.files[texture["source"]])   # a datablock of its own: its own colour space
        image.colorspace_settings.name = "sRGB" if color else "Non-Color"
        image.alpha_mode = "CHANNEL_PACKED"
        wraps = {sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)}
        node = t.node("TexImage", {"Vector": vector}, image=image,
                      extension="EXTEND" if wraps == {33071} else "REPEAT",
                      interpolation="Closest" if sampler.get("magFilter") == 9728 else "Linear")
        self.cache[key] = node
        return node

    def channel(self, info, which):
        node = self.texture(info, False)
        if node is None:
            return None
        if which == "a":
            return node.outputs["Alpha"]
        return self.tree.node("SeparateRGB", {0: node.outputs["Color"]}).outputs["rgb".index(which)]

    def value(self, factor, info, which):
        """factor times a texture channel."""
        socket = self.channel(info, which)
        return factor if socket is None else self.tree.math("MULTIPLY", socket, factor)

    def color(self, factor, info):
        node = self.texture(info, True)
        factor = tuple(factor[:3])
        return factor if node is None else self.tree.times(node.outputs["Color"], factor)

    def normal(self):
        info = self.m.get("normalTexture")
        node = self.texture(info, False)
        if node is None:
            return None
        uv = "UVMap" if info.get("texCoord", 0) == 0 else f"UVMap.{info['texCoord']:03d}"
        return self.tree.node("NormalMap", {"Strength": info.get("scale", 1), "Color": node.outputs["Color"]},
                              uv_map=uv).outputs[0]

    def cosine(self, normal):
        """|cosine| of the view direction."""
        t = self.tree
        geometry = t.node("NewGeometry")
        dot = t.node("VectorMath", {0: normal or geometry.outputs["Normal"], 1: geometry.outputs["Incoming"]},
                     operation="DOT_PRODUCT").outputs["Value"]
        return t.math("ABSOLUTE", dot)

    def schlick(self, cosine):
        return self.tree.math("POWER", self.tree.math("SUBTRACT", 1.0, cosine), 5.0)

    def lookup(self, name, values, cosine, rough):
        """Colour of a table (ROUGH, MU, 3) at a cosine and a roughness."""
        t = self.tree
        image = bpy.data.images.get(name)
        if image is None:
            rows, columns = values.shape[:2]
            image = bpy.data.images.new(name, columns, rows, float_buffer=True, is_data=True)
            image.colorspace_settings.name = "Non-Color"
            texels = np.concatenate([values, np.ones((rows, columns, 1))], 2)
            image.pixels.foreach_set(texels.astype(np.float32).ravel())
            image.update()
            image.pack()
        columns, rows = image.size
        x = t.math("MULTIPLY", t.math("SQRT", cosine), (columns - 1) / columns)
        y = t.math("MULTIPLY", rough, (rows - 1) / rows)
        at = t.node("CombineXYZ", {0: t.math("ADD", x, 0.5 / columns), 1: t.math("ADD", y, 0.5 / rows)}).outputs[0]
        return t.node("TexImage", {"Vector": at}, image=image, extension="EXTEND", interpolation="Linear").outputs[0]

    def glossy(self, rough, color, normal):
        """A mirror, or a rough lobe with F = color throughout."""
        sharp = rough == 0
        return self.tree.node("BsdfGlossy", {"Color": color, "Roughness": rough, "Normal": normal},
                              distribution="SHARP" if sharp else "MULTI_GGX").outputs[0]

    def lobe(self, rough, f0, normal):
        """GGX with F = f0 + (1 - f0) Schlick."""
        t = self.tree
        cosine = self.cosine(normal)
        if rough == 0:
            color = t.node("MixRGB", {"Fac": self.schlick(cosine), "Color1": f0, "Color2": (1, 1, 1)}).outputs[0]
            return self.glossy(0, color, normal)
        closure = self.fresnel_lobe(rough, f0, normal, "MULTI_GGX")
        # Albedo with Schlick's curve over that with the closure's; of the channels together.
        e = t.node("SeparateRGB", {0: self.lookup("lobes", microfacet.lobes()[:, :, :3], cosine, rough)}).outputs
        grey = sum(f0) / 3 if isinstance(f0, (tuple, list)) else t.node("RGBToBW", {0: f0}).outputs[0]

        def albedo(curve):
            return t.math("ADD", t.math("MULTIPLY", grey, t.math("SUBTRACT", e[0], curve)), curve)

        return t.blend(t.math("MINIMUM", t.math("DIVIDE", albedo(e[1]), albedo(e[2])), 1.0), None, closure)

    def fresnel_lobe(self, rough, f0, normal, distribution):
        """GGX whose factor goes from f0 to white by the closure's own curve (microfacet.closure_curve)."""
        return self.tree.node("BsdfPrincipled", {"Base Color": f0, "Metallic": 1.0, "Specular": 0.5, "Roughness": rough,
                                                 "Normal": normal}, distribution=distribution).outputs[0]

    def coated(self, base, rough, normal, specular, tint, ior):
        """The diffuse lobes below a coat, and the coat; without one where `specular` is 0."""
        t, ext = self.tree, self.ext
        through = ext.get("KHR_materials_diffuse_transmission")
        factor, passed = 0, (1, 1, 1)
        if through:
            factor = self.value(through.get("diffuseTransmissionFactor", 0),
                                through.get("diffuseTransmissionTexture"), "a")
            passed = self.color(through.get("diffuseTransmissionColorFactor", (1, 1, 1)),
                                through.get("diffuseTransmissionColorTexture"))
        plain = self.lambert
        if not specular:
            return t.blend(factor, plain(base, normal), self.translucent(passed, normal) if through else None)
        f0 = tuple(min(1.0, ((ior - 1) / (ior + 1)) ** 2 * v) * specular for v in tint)
        cosine = self.cosine(normal)
        name = "coat %.4f %.4f %.4f %.4f" % (*f0, specular)
        tables = [microfacet.coat(v, specular) for v in f0] if len(set(f0)) > 1 else [microfacet.coat(f0[0], specular)] * 3
        view = self.lookup(name, np.stack([table[0] for table in tables], 2), cosine, rough)
        weights = np.repeat(tables[0][1][:, None, [0, 1, 1]], 2, 1)
        weights = t.node("SeparateRGB", {0: self.lookup(name + " weights", weights, cosine, rough)}).outputs
        below = t.times(base, view)
        fade = t.math("SUBTRACT", 1.0, t.math("MULTIPLY", self.schlick(cosine), 0.5))   # the term's factor of this side
        term = t.node("BsdfPrincipled", {"Base Color": self.scaled(below, t.math("DIVIDE", weights[1], fade)),
                                         "Specular": 0.0, "Roughness": 0.0, "Normal": normal}).outputs[0]
        diffuse = t.node("AddShader", {0: self.lambert(self.scaled(below, weights[0]), normal), 1: term}).outputs[0]
        if through:
            diffuse = t.blend(factor, diffuse, self.translucent(t.times(passed, view), normal))
        color = tuple(v / specular for v in f0)
        if rough == 0:
            mirror = t.blend(specular, None, self.lobe(0, color, normal))
        else:
            # The plain closure: Blender's multiple-scattering one, sampled with an approximate density, puts 1-2 % of
            # energy into closures beside it. The weight may exceed 1, a mix's factor not: half of it, twice.
            ratio = np.repeat(np.mean([table[2] for table in tables], 0)[:, :, None], 3, 2)
            half = t.math("MULTIPLY", self.lookup(name + " lobe", ratio, cosine, rough), 0.5 * specular)
            mirror = t.blend(half, None, self.fresnel_lobe(rough, color, normal, "GGX"))
            mirror = t.node("AddShader", {0: mirror, 1: mirror}).outputs[0]
        return t.node("AddShader", {0: diffuse, 1: mirror}).outputs[0]

    def scaled(self, color, factor):
        """A colour times a number, of any sign and size."""
        return self.tree.node("VectorMath", {0: color, "Scale": factor}, operation="SCALE").outputs[0]

    def lambert(self, color, normal):
        return self.tree.node("BsdfDiffuse", {"Color": color, "Roughness": 0.0, "Normal": normal}).outputs[0]

    def translucent(self, color, normal):
        return self.tree.node("BsdfTranslucent", {"Color": color, "Normal": normal}).outputs[0]

    def dielectric(self, base, rough, normal):
        """Everything that is not metal."""
        t, ext = self.tree, self.ext
        shine = ext.get("KHR_materials_specular", {})
        specular, tint = shine.get("specularFactor", 1), shine.get("specularColorFactor", (1, 1, 1))
        ior = ext.get("KHR_materials_ior", {}).get("ior", 1.5)
        passing = ext.get("KHR_materials_transmission")
        factor = self.value(passing.get("transmissionFactor", 0), passing.get("transmissionTexture"), "r") \
            if passing else 0
        body = self.coated(base, rough, normal, specular, tint, ior) if factor != 1 else None
        if not passing:
            return body
        if ext.get("KHR_materials_volume", {}).get("thicknessFactor", 0) > 0:
            glass = t.node("BsdfGlass", {"Color": (1, 1, 1), "Roughness": rough, "IOR": ior, "Normal": normal},
                           distribution="SHARP" if rough == 0 else "MULTI_GGX").outputs[0]
            if rough != 0 or base != (1, 1, 1):   # tints what passes, not what is reflected
                glass = self.tinted_glass(base, rough, normal, ior)
            return t.blend(factor, body, glass)
        # A slab: 2R / (1 + R) with the same R on both sides; the node inverts the index on the back.
        back = t.node("NewGeometry").outputs["Backfacing"]
        index = t.node("MixRGB", {"Fac": back, "Color1": (ior,) * 3, "Color2": (1 / ior,) * 3}).outputs[0]
        once = t.node("Fresnel", {"IOR": index, "Normal": normal}).outputs[0]
        slab = t.math("DIVIDE", t.math("MULTIPLY", once, 2.0), t.math("ADD", once, 1.0))
        clear = t.node("BsdfTransparent", {"Color": base}).outputs[0] if rough == 0 else t.node(
            "BsdfRefraction", {"Color": base, "Roughness": rough, "IOR": 1.0, "Normal": normal},
            distribution="GGX").outputs[0]
        return t.blend(factor, body, t.blend(slab, clear, self.glossy(rough, (1, 1, 1), normal)))

    def tinted_glass(self, base, rough, normal, ior):
        t = self.tree
        kind = "SHARP" if rough == 0 else "GGX"
        F = t.node("Fresnel", {"IOR": ior, "Normal": normal}).outputs[0]
        mirror = t.node("BsdfGlossy", {"Color": (1, 1, 1), "Roughness": rough, "Normal": normal},
                        distribution=kind).outputs[0]
        return t.blend(F, t.node("BsdfRefraction", {"Color": base, "Roughness": rough, "IOR": ior, "Normal": normal},
                                 distribution=kind).outputs[0], mirror)

    def build(self):
        t, m, ext = self.tree, self.m, self.ext
        pbr = m.get("pbrMetallicRoughness", {})
        base = self.color(pbr.get("baseColorFactor", (1, 1, 1, 1)), pbr.get("baseColorTexture"))
        alpha = pbr.get("baseColorFactor", (1, 1, 1, 1))[3]
        if self.texture(pbr.get("baseColorTexture"), True) is not None:
            alpha = t.math("MULTIPLY", self.texture(pbr["baseColorTexture"], True).outputs["Alpha"], alpha)
        if self.colored:
            attribute = t.node("VertexColor", layer_name=self.colored)
            base = t.times(attribute.outputs["Color"], base)
            alpha = t.math("MULTIPLY", attribute.outputs["Alpha"], alpha)
        rough = self.value(pbr.get("roughnessFactor", 1), pbr.get("metallicRoughnessTexture"), "g")
        if not isinstance(rough, bpy.types.NodeSocket) and rough * rough < 1e-3:
            rough = 0   # smooth in Lucerna: k_delta_alpha
        metal = self.value(pbr.get("metallicFactor", 1), pbr.get("metallicRoughnessTexture"), "b")
        normal = self.normal()
        geometry = t.node("NewGeometry")
        front = t.math("SUBTRACT", 1.0, geometry.outputs["Backfacing"])
        if "KHR_materials_unlit" in ext:
            out = t.node("Emission", {"Color": base}).outputs[0]
        else:
            body = self.dielectric(base, rough, normal) if metal != 1 else None
            conductor = self.lobe(rough, base, normal) if metal != 0 else None
            out = t.blend(metal, body, conductor)
            strength = ext.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
            factor = m.get("emissiveFactor", (0, 0, 0))
            if any(factor):
                light = t.node("Emission", {"Color": self.color(factor, m.get("emissiveTexture")),
                                            "Strength": strength if m.get("doubleSided")
                                            else t.math("MULTIPLY", front, strength)}).outputs[0]
                out = t.node("AddShader", {0: out, 1: light}).outputs[0]
        mode = m.get("alphaMode", "OPAQUE")
        if mode != "OPAQUE":
            cover = t.math("SUBTRACT", 1.0, t.math("LESS_THAN", alpha, m.get("alphaCutoff", 0.5))) \
                if mode == "MASK" and isinstance(alpha, bpy.types.NodeSocket) else alpha
            out = t.blend(cover, t.node("BsdfTransparent").outputs[0], out)
        surface = t.node("OutputMaterial")
        t.links.new(out, surface.inputs["Surface"])
        self.absorb(surface)

    def absorb(self, surface):
        volume = self.ext.get("KHR_materials_volume", {})
        color = volume.get("attenuationColor", (1, 1, 1))
        if volume.get("thicknessFactor", 0) > 0 and min(color) < 1 and "attenuationDistance" in volume:
            sigma = [-math.log(max(c, 1e-6)) / volume["attenuationDistance"] for c in color]
            top = max(sigma)
            node = self.tree.node("VolumeAbsorption", {"Color": tuple(1 - v / top for v in sigma), "Density": top})
            self.tree.links.new(node.outputs[0], surface.inputs["Volume"])


def replace_all(doc, files):
    """Rebuilds the materials m0, m1, ... that the bare import made."""
    colored = {}
    for mesh in bpy.data.meshes:
        layers = [a.name for a in mesh.color_attributes]
        for material in mesh.materials:
            if material is not None and layers:
                colored[material.name] = layers[0]
    for i in range(len(doc.get("materials", []))):
        if f"m{i}" in bpy.data.materials:
            Material(doc, files, i, colored.get(f"m{i}")).build()
