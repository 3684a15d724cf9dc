"""Copies of a scene without some features, to find the one on which two renderers disagree.

  normals    normal maps                      coats      the specular lobe of dielectrics (specularFactor 0)
  metals     metals become Lambertian         glass      transmission: left out, with its volume
  textures   all textures                     cloth      diffuse transmission
  alpha      alpha masks and blending         lamps      emission of materials
  sun        punctual lights                  sky        the environment
"""
import json
import os

FEATURES = ("normals", "coats", "metals", "glass", "textures", "cloth", "alpha", "lamps", "sun", "sky")


def without_textures(item):
    """The item without keys that name textures, at any depth."""
    if isinstance(item, dict):
        return {k: without_textures(v) for k, v in item.items() if not k.endswith("Texture")}
    return [without_textures(v) for v in item] if isinstance(item, list) else item


def reduce_material(m, features):
    ext = m.setdefault("extensions", {})
    pbr = m.setdefault("pbrMetallicRoughness", {})
    if "textures" in features:
        m = without_textures(m)
        ext, pbr = m["extensions"], m["pbrMetallicRoughness"]
    if "normals" in features:
        m.pop("normalTexture", None)
    if "metals" in features and pbr.get("metallicFactor", 1) > 0:
        pbr["metallicFactor"] = 0
        ext["KHR_materials_specular"] = {"specularFactor": 0}
    if "coats" in features and not ext.get("KHR_materials_transmission"):
        ext["KHR_materials_specular"] = {"specularFactor": 0}
    if "glass" in features:
        ext.pop("KHR_materials_transmission", None)
        ext.pop("KHR_materials_volume", None)
    if "cloth" in features:
        ext.pop("KHR_materials_diffuse_transmission", None)
    if "alpha" in features:
        m.pop("alphaMode", None)
    if "lamps" in features:
        m.pop("emissiveFactor", None)
    return m


def reduced(scene, features, folder):
    """Writes the copy into `folder`, with links to the scene's other files; the path of its glTF."""
    source = os.path.dirname(os.path.abspath(scene))
    target = os.path.join(folder, "without-" + "-".join(features))
    os.makedirs(target, exist_ok=True)
    for name in os.listdir(source):
        link = os.path.join(target, name)
        if name.endswith((".gltf", ".json")) or os.path.lexists(link):
            continue
        os.symlink(os.path.join(source, name), link)
    doc = json.load(open(scene))
    doc["materials"] = [reduce_material(m, features) for m in doc.get("materials", [])]
    if "sun" in features:
        doc.get("extensions", {}).pop("KHR_lights_punctual", None)
        for node in doc["nodes"]:
            node.get("extensions", {}).pop("KHR_lights_punctual", None)
    settings_path = os.path.join(source, "settings.json")
    settings = json.load(open(settings_path)) if os.path.exists(settings_path) else {}
    if "sky" in features:
        settings.pop("environment", None)
        for s in doc["scenes"]:
            s.get("extras", {}).pop("environment", None)
    json.dump(settings, open(os.path.join(target, "settings.json"), "w"))
    path = os.path.join(target, os.path.basename(scene))
    json.dump(doc, open(path, "w"))
    return path
