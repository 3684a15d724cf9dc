"""Five finishes on a lacquered board in a plastered niche (`finishes`): varnish over wood and over metal, velvet, brushed
steel, a soap bubble and a tempered ball. Daylight falls in from the left, through a window that the ball shows.

Each finish needs a lobe of its own: clear coat, sheen, anisotropy, thin film. The cushion has three variants.
"""
import os

import numpy as np

import textures
from gltf import Scene, join
from shapes import box, chamfer, facing, grid, lathe, quad, rotate, sphere, superquadric, translate


def materials(s):
    s.material("plaster", (0.62, 0.58, 0.53), lambert=True)
    s.material("back wall", (0.20, 0.235, 0.23), lambert=True)
    s.material("sky light", (0, 0, 0), lambert=True, emit=(0.86, 0.95, 1.0), strength=9.0)
    s.material("warm light", (0, 0, 0), lambert=True, emit=(1.0, 0.74, 0.46), strength=16.0)
    s.material("frame", (0.05, 0.05, 0.05), rough=0.5)
    textures.png(os.path.join(s.folder, "wood.png"), textures.to_srgb(textures.wood(512).color))
    s.material("lacquered oak", (0.62, 0.46, 0.36), rough=0.62, maps={"color": "wood.png"}, metres=(0.8, 0.8),
               layers={"clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.06}})
    s.material("car paint", (0.42, 0.025, 0.02), rough=0.42, metal=0.75,
               layers={"clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.0}})
    for name, base, sheen in (("teal velvet", (0.008, 0.055, 0.060), (0.30, 0.72, 0.70)),
                              ("plum velvet", (0.055, 0.010, 0.040), (0.75, 0.34, 0.60)),
                              ("ochre velvet", (0.16, 0.075, 0.012), (0.90, 0.66, 0.28))):
        s.material(name, base, rough=1.0, specular=0,
                   layers={"sheen": {"sheenColorFactor": list(sheen), "sheenRoughnessFactor": 0.45}})
    s.material("piping", (0.30, 0.19, 0.06), rough=0.5)
    s.material("brushed steel", (0.66, 0.65, 0.63), rough=0.26, metal=1.0,
               layers={"anisotropy": {"anisotropyStrength": 0.85}})
    s.material("tempered steel", (0.58, 0.55, 0.52), rough=0.12, metal=1.0,
               layers={"iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.8,
                                       "iridescenceThicknessMaximum": 265}})
    s.material("soap", (1, 1, 1), glass=0.0, thin=True, ior=1.33,
               layers={"iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.33,
                                       "iridescenceThicknessMaximum": 430}})
    s.material("brass", (0.83, 0.61, 0.30), rough=0.22, metal=1.0,
               layers={"anisotropy": {"anisotropyStrength": 0.6}})


def board():
    """The board, its grain along x: uv in metres."""
    m = chamfer((-0.62, -0.035, -0.26), (0.62, 0.0, 0.24), 0.004)
    return m.with_uv(np.stack([m.p[:, 2] + 0.3 * m.p[:, 1], m.p[:, 0]], 1))


def dish(radius=0.118):
    """A turned dish that stands on its rim; u runs around, and so does the brushing."""
    profile = [(0.0, 0.0)] + [(radius * t, 0.006 + 0.020 * t ** 3) for t in np.linspace(0.05, 0.97, 24)]
    rim = [(radius, 0.0285), (radius + 0.0008, 0.031), (radius - 0.001, 0.033), (radius - 0.004, 0.0315)]
    inside = [((radius - 0.006) * t, 0.0105 + 0.0195 * t ** 3) for t in np.linspace(0.97, 0.05, 24)] + [(0.0, 0.0104)]
    return lathe(profile + rim + inside, 128, smooth=45)


def candlestick(height=0.21):
    return lathe([(0, 0), (0.048, 0), (0.050, 0.003), (0.048, 0.008), (0.030, 0.013), (0.012, 0.022), (0.009, 0.040),
                  (0.013, 0.052), (0.009, 0.066), (0.007, 0.12), (0.0075, height - 0.045), (0.013, height - 0.034),
                  (0.008, height - 0.026), (0.017, height - 0.012), (0.021, height - 0.002), (0.020, height),
                  (0.012, height - 0.002), (0.011, height - 0.012), (0, height - 0.012)], 96, smooth=38)


def cushion():
    return superquadric((0.135, 0.052, 0.135), 0.42, 0.86, 96, 40)


def ring_of(radius, thick):
    """A cord around a cushion of that half width."""
    a = np.linspace(0, 2 * np.pi, 97)
    x, z = (radius * np.sign(f(a)) * np.abs(f(a)) ** 0.42 for f in (np.sin, np.cos))
    path = np.stack([x, 0 * a, z], 1)
    b = np.linspace(0, 2 * np.pi, 13)
    tangent = np.gradient(path, axis=0)
    tangent[0] = tangent[-1] = path[1] - path[-2]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    out = np.cross([0, 1, 0], tangent)
    rows = path[:, None] + thick * (np.cos(b)[None, :, None] * out[:, None] +
                                    np.sin(b)[None, :, None] * np.array([0, 1, 0])[None, None])
    return facing(grid(rows))


def window(s):
    """A tall window of four panes on the left, and a low lamp on the right, both outside the picture."""
    panes = []
    for y0, y1 in ((0.10, 0.52), (0.56, 0.98)):
        for z0, z1 in ((-0.30, 0.12), (0.16, 0.58)):
            panes.append(quad((0, y0, z0), (0, y1, z0), (0, y1, z1), (0, y0, z1)))
    s.mesh("window", [(join(panes), "sky light")])
    s.place("window", (-1.15, 0.0, 0.0))
    s.mesh("bars", [(join([box((-0.03, 0.06, -0.34), (-0.005, 1.02, 0.62))]), "frame")])
    s.place("bars", (-1.15, 0.0, 0.0))
    s.mesh("lamp", [(quad((0, 0.20, -0.05), (0, 0.20, 0.13), (0, 0.38, 0.13), (0, 0.38, -0.05)), "warm light")])
    s.place("lamp", (1.02, 0.0, 0.45))


def niche(s):
    """Floor, back, sides and ceiling of the room around the board."""
    x, y0, y1, z0, z1 = 1.25, -0.45, 1.35, -0.42, 1.7
    s.mesh("room", [(join([quad((-x, y0, z1), (x, y0, z1), (x, y0, z0), (-x, y0, z0)),
                           quad((-x, y1, z0), (x, y1, z0), (x, y1, z1), (-x, y1, z1)),
                           quad((-x, y0, z1), (-x, y0, z0), (-x, y1, z0), (-x, y1, z1)),
                           quad((x, y0, z0), (x, y0, z1), (x, y1, z1), (x, y1, z0)),
                           quad((x, y0, z1), (-x, y0, z1), (-x, y1, z1), (x, y1, z1))]), "plaster"),
                    (quad((-x, y0, z0), (x, y0, z0), (x, y1, z0), (-x, y1, z0)), "back wall")])
    s.place("room")


def main():
    s = Scene("finishes")
    materials(s)
    niche(s)
    window(s)
    s.mesh("board", [(board(), "lacquered oak")])
    s.place("board")
    s.mesh("cushion", [(cushion(), "teal velvet")])
    s.variants("cushion", {"teal": "teal velvet", "plum": "plum velvet", "ochre": "ochre velvet"})
    s.mesh("piping", [(ring_of(0.1345, 0.0034), "piping")])
    tilt = translate(-0.335, 0.098, -0.115) @ rotate("y", 22) @ rotate("x", 62)
    s.place("cushion", matrix=tilt)
    s.place("piping", matrix=tilt)
    s.mesh("paint ball", [(sphere(0.078, 128, 64), "car paint")])
    s.place("paint ball", (-0.125, 0.078, 0.020))
    s.mesh("dish", [(dish(), "brushed steel")])
    s.place("dish", matrix=translate(0.075, 0.1185, -0.135) @ rotate("y", -10) @ rotate("x", 76))
    s.mesh("tempered ball", [(sphere(0.050, 128, 64), "tempered steel")])
    s.place("tempered ball", (0.055, 0.050, 0.075))
    s.mesh("candlestick", [(candlestick(), "brass")])
    s.place("candlestick", (0.245, 0.0, -0.030))
    s.mesh("bubble", [(sphere(0.064, 128, 64), "soap")])
    s.place("bubble", (0.245, 0.272, -0.030))
    s.mesh("small bubble", [(sphere(0.030, 96, 48), "soap")])
    s.place("small bubble", (0.335, 0.165, 0.060))
    s.camera("main", (0.05, 0.36, 1.30), (-0.012, 0.140, -0.03), yfov=25.5)
    s.write("Varnished wood and metal, velvet, brushed steel, a soap bubble and a tempered ball by a window: the finishes "
            "that need a lobe of their own. The cushion has three variants.", {"film.ev": 0.4})


if __name__ == "__main__":
    main()
