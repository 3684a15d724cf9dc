"""Runs inside Blender: node trees that mean what the glTF material means.

Lambert, sharp glass, thin glass, diffuse transmission, emission and textures are exact. A coated dielectric is a mix of
diffuse and glossy by the Fresnel factor of the view direction; a rough coloured metal takes Schlick's factor at the view
direction: close, but outside any comparison at 1 %.
"""
import math

import bpy


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
            return {"MULTIPLY": a * b, "SUBTRACT": a - b, "ADD": a + b}[operation]
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

    def schlick(self, normal):
        """(1 - cos)^5 of the view direction, either side."""
        t = self.tree
        geometry = t.node("NewGeometry")
        cosine = t.node("VectorMath", {0: normal or geometry.outputs["Normal"], 1: geometry.outputs["Incoming"]},
                        operation="DOT_PRODUCT").outputs["Value"]
        return t.math("POWER", t.math("SUBTRACT", 1.0, t.math("ABSOLUTE", cosine)), 5.0)

    def glossy(self, rough, color, normal):
        sharp = rough == 0
        return self.tree.node("BsdfGlossy", {"Color": color, "Roughness": rough, "Normal": normal},
                              distribution="SHARP" if sharp else "MULTI_GGX").outputs[0]

    def dielectric(self, base, rough, normal, F):
        """Everything that is not metal."""
        t, ext = self.tree, self.ext
        diffuse = t.node("BsdfDiffuse", {"Color": base, "Roughness": 0.0, "Normal": normal}).outputs[0]
        through = ext.get("KHR_materials_diffuse_transmission")
        if through:
            factor = self.value(through.get("diffuseTransmissionFactor", 0),
                                through.get("diffuseTransmissionTexture"), "a")
            tint = self.color(through.get("diffuseTransmissionColorFactor", (1, 1, 1)),
                              through.get("diffuseTransmissionColorTexture"))
            translucent = t.node("BsdfTranslucent", {"Color": tint, "Normal": normal}).outputs[0]
            diffuse = t.blend(factor, diffuse, translucent)
        below = diffuse
        passing = ext.get("KHR_materials_transmission")
        thickness = ext.get("KHR_materials_volume", {}).get("thicknessFactor", 0)
        ior = ext.get("KHR_materials_ior", {}).get("ior", 1.5)
        if passing:
            factor = self.value(passing.get("transmissionFactor", 0), passing.get("transmissionTexture"), "r")
            if thickness > 0:
                glass = t.node("BsdfGlass", {"Color": base, "Roughness": rough, "IOR": ior, "Normal": normal},
                               distribution="SHARP" if rough == 0 else "MULTI_GGX").outputs[0]
                if factor == 1:
                    return glass   # carries its own Fresnel factor
                return t.blend(factor, t.blend(F, diffuse, self.glossy(rough, (1, 1, 1), normal)), glass)
            clear = t.node("BsdfTransparent", {"Color": base}).outputs[0] if rough == 0 else t.node(
                "BsdfRefraction", {"Color": base, "Roughness": rough, "IOR": 1.0, "Normal": normal},
                distribution="GGX").outputs[0]
            below = t.blend(factor, diffuse, clear)
        tint = ext.get("KHR_materials_specular", {}).get("specularColorFactor", (1, 1, 1))
        return t.blend(F, below, self.glossy(rough, tuple(min(v, 1) for v in tint), normal))

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
        metal = self.value(pbr.get("metallicFactor", 1), pbr.get("metallicRoughnessTexture"), "b")
        normal = self.normal()
        geometry = t.node("NewGeometry")
        front = t.math("SUBTRACT", 1.0, geometry.outputs["Backfacing"])
        if "KHR_materials_unlit" in ext:
            out = t.node("Emission", {"Color": base}).outputs[0]
        else:
            specular = ext.get("KHR_materials_specular", {}).get("specularFactor", 1)
            ior = ext.get("KHR_materials_ior", {}).get("ior", 1.5)
            F = t.math("MULTIPLY", t.node("Fresnel", {"IOR": ior, "Normal": normal}).outputs[0], specular) \
                if specular else 0
            body = self.dielectric(base, rough, normal, F) if metal != 1 else None
            conductor = None
            if metal != 0:
                tint = base
                if base != (1, 1, 1):
                    tint = t.node("MixRGB", {"Fac": self.schlick(normal), "Color1": base,
                                             "Color2": (1, 1, 1)}).outputs[0]
                conductor = self.glossy(rough, tint, normal)
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
