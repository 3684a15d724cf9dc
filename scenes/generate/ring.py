"""Two polished rings on wood under a small lamp (`ring`): the cardioid in each, and what a ring throws outside.

The lamp is a bead of 8 mm, so that paths from the eye meet it by the thousandth part of a hemisphere; all light that the
rings focus is a caustic on diffuse wood.
"""
import os

import numpy as np

import textures
from gltf import Scene, hdr
from shapes import lathe, quad, sphere


def wood(n=1024):
    """Oiled cherry, 14 cm, grain along u: pores, figure and the rings of years."""
    rings = textures.noise((n, n), 611, 1.2, 3, 120, (1.0, 18.0))
    figure = textures.noise((n, n), 612, 1.7, 1, 16, (1.0, 5.0))
    fine = textures.noise((n, n), 613, 0.5, 60, 400, (1.0, 12.0))
    pores = textures.smooth(textures.noise((n, n), 614, 0.3, 60, 320, (1.0, 10.0)), 1.5, 2.8)
    t = np.clip(0.5 + 0.20 * rings + 0.16 * figure + 0.05 * fine, 0, 1)
    color = textures.mix(textures.rgb(0.52, 0.30, 0.155), textures.rgb(0.30, 0.145, 0.066), t)
    return textures.Surface(color * (1 - 0.45 * pores)[..., None], np.zeros((n, n)), (0.14, 0.14))


def band(inner, outer, height, segments=512):
    """A ring with a domed outside, a slightly domed inside and rounded rims."""
    a = np.linspace(-1, 1, 49)
    dome = np.sqrt(np.maximum(0, 1 - np.abs(a) ** 2.6))
    bulge = outer - inner
    out = [(inner + 0.35 * bulge + 0.65 * bulge * d, height * (x + 1) / 2) for x, d in zip(a, dome)]
    back = [(inner + 0.35 * bulge * (1 - min(1, 4 * d) ** 0.5), height * (x + 1) / 2) for x, d in zip(a[::-1], dome[::-1])]
    return lathe(out + back[1:], segments)


def room(width=64):
    """A dim room: a cool window to the right behind, a pale ceiling, dark walls; (h, w, 3) radiance."""
    h = width // 2
    v, u = (np.arange(h) + 0.5) / h, (np.arange(width) + 0.5) / width
    up = np.repeat(np.cos(np.pi * v)[:, None], width, 1)
    phi = np.repeat(2 * np.pi * (u[None, :] - 0.5), h, 0)
    ceiling = textures.smooth(up, 0.1, 0.9)[..., None] * np.array([0.20, 0.19, 0.175])
    away = np.abs((phi + 0.9 + np.pi) % (2 * np.pi) - np.pi)
    window = (textures.smooth(-away, -0.42, -0.34) * textures.smooth(up, 0.16, 0.20) *
              textures.smooth(-up, -0.72, -0.66))[..., None] * np.array([0.75, 0.95, 1.2]) * 2.2
    return np.array([0.030, 0.027, 0.025]) + ceiling + window


def main():
    s = Scene("ring")
    s.material("wood", (1, 1, 1), lambert=True, maps=wood().save(s.folder, "wood", normal=False), metres=0.14)
    s.material("gold", (1.0, 0.76, 0.33), rough=0, metal=1)
    s.material("white gold", (0.86, 0.83, 0.77), rough=0, metal=1)
    s.material("lamp", (0, 0, 0), lambert=True, emit=(1.0, 0.86, 0.66), strength=2600)
    half = 0.45
    table = quad((-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half))
    s.mesh("table", [(table.with_uv(table.p[:, [0, 2]]), "wood")])
    s.place("table")
    s.mesh("wide ring", [(band(0.0096, 0.0110, 0.0042), "gold")])
    s.mesh("narrow ring", [(band(0.0084, 0.0097, 0.0034), "white gold")])
    s.place("wide ring", (-0.0085, 0, 0.001))
    s.place("narrow ring", (0.0138, 0, 0.0082))
    s.mesh("lamp", [(sphere(0.008, 48, 24), "lamp")])
    s.place("lamp", (-0.180, 0.120, -0.120))
    hdr(os.path.join(s.folder, "room.hdr"), room())
    s.camera("main", (0.010, 0.070, 0.078), (0.0022, 0.0, 0.0040), yfov=22)
    s.write("Two polished rings on wood under a lamp of 8 mm in a dim room: the cardioid inside, and the arcs that "
            "they throw outside. Nearly all that is bright is a caustic.", {"film.ev": -0.35, "components.caustic": "photons",
             "environment": {"file": "room.hdr", "scale": 1}})


if __name__ == "__main__":
    main()
