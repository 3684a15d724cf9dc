"""A tiled basin with waves under a low sun, before a wall in the shade of its roof (`pool`).

What the water mirrors plays on wall and roof, where the sun does not come; what it lets through draws the net on the
tiles below, which is seen through the water again (SDS: paths from the eye cannot aim at the sun through a wave). A lamp
on the wall does the same for the near end.
"""
import os

import numpy as np

import textures
from gltf import Scene, hdr, join
from shapes import box, grid, quad, sphere

SUN = np.array([0.36, -0.36, -0.86])       # along which it shines
X, Z, DEEP, LEVEL = 3.4, 2.1, 1.35, -0.09  # half of the basin's width and length; its depth; the water's level


def tiles(n=1024, count=10, seed=5):
    """Glazed mosaic, 1 m: tiles of 10 cm in turquoise, each of its own tone, with pale joints."""
    rs = np.random.RandomState(seed)
    y, x = np.mgrid[0:n, 0:n]
    i, j = y * count // n, x * count // n
    tone = rs.rand(count, count)[i, j]
    u, v = (x * count / n) % 1 - 0.5, (y * count / n) % 1 - 0.5
    joint = textures.smooth(np.maximum(abs(u), abs(v)), 0.462, 0.478)
    cloud = textures.noise((n, n), seed + 1, 1.3, 3, 90)
    color = textures.mix(textures.rgb(0.30, 0.60, 0.66), textures.rgb(0.42, 0.72, 0.74), tone)
    color = color * (1 + 0.03 * cloud)[..., None]
    return textures.Surface(textures.mix(color, textures.rgb(0.74, 0.76, 0.74), joint), np.zeros((n, n)), (1.0, 1.0))


def stone(n=1024, seed=31):
    """Dark travertine slabs of 50 cm, 2 m."""
    color, _ = textures.stone_tone((n, n), seed, textures.rgb(0.36, 0.325, 0.28), textures.rgb(0.27, 0.235, 0.195), 0.8)
    y, x = np.mgrid[0:n, 0:n]
    u, v = (x * 4 / n) % 1 - 0.5, (y * 4 / n) % 1 - 0.5
    joint = textures.smooth(np.maximum(abs(u), abs(v)), 0.490, 0.496)
    return textures.Surface(color * (1 - 0.45 * joint)[..., None], np.zeros((n, n)), (2.0, 2.0))


def water():
    """The surface: a dozen plane waves that run every way, none steeper than a few degrees."""
    rs = np.random.RandomState(17)
    nx, nz = 420, 260
    x, z = np.meshgrid(np.linspace(-X - 0.01, X + 0.01, nx), np.linspace(-Z - 0.01, Z + 0.01, nz))
    y = np.zeros_like(x)
    dx, dz = np.zeros_like(x), np.zeros_like(x)
    for k in range(16):
        length = 0.30 * 1.17 ** k * (0.9 + 0.2 * rs.rand())
        angle, phase = rs.rand() * 2 * np.pi, rs.rand() * 2 * np.pi
        steep = 0.022 * (1 if k < 10 else 0.6)
        w = 2 * np.pi / length
        a = w * (np.cos(angle) * x + np.sin(angle) * z) + phase
        y += steep / w * np.sin(a)
        dx += steep * np.cos(angle) * np.cos(a)
        dz += steep * np.sin(angle) * np.cos(a)
    n = np.stack([-dx, np.ones_like(x), -dz], 2)
    return grid(np.stack([x, LEVEL + y, z], 2), n.reshape(-1, 3))


def textured(mesh, plane):
    """uv in metres from two axes of the position."""
    return mesh.with_uv(mesh.p[:, list(plane)])


def basin():
    lo, hi = -DEEP, 0.0
    floor = textured(quad((-X, lo, Z), (X, lo, Z), (X, lo, -Z), (-X, lo, -Z)), (0, 2))
    back = textured(quad((-X, lo, -Z), (X, lo, -Z), (X, hi, -Z), (-X, hi, -Z)), (0, 1))
    front = textured(quad((X, lo, Z), (-X, lo, Z), (-X, hi, Z), (X, hi, Z)), (0, 1))
    left = textured(quad((-X, lo, Z), (-X, lo, -Z), (-X, hi, -Z), (-X, hi, Z)), (2, 1))
    right = textured(quad((X, lo, -Z), (X, lo, Z), (X, hi, Z), (X, hi, -Z)), (2, 1))
    # two steps along the left side
    steps = [box((-X, lo, -Z), (-X + 0.9 - 0.45 * k, lo + 0.4 * (k + 1), Z), skip="-x -y -z +z") for k in range(2)]
    return join([floor, back, front, left, right] + [textured(b, (0, 2)) for b in steps])


def deck(far=9.0, wall=-Z - 1.5):
    edges = (-far, -X, X, far), (wall, -Z, Z, 7.0)
    parts = []
    for i in range(3):
        for k in range(3):
            if i == 1 and k == 1:
                continue
            (x0, x1), (z0, z1) = edges[0][i:i + 2], edges[1][k:k + 2]
            parts.append(quad((x0, 0, z1), (x1, 0, z1), (x1, 0, z0), (x0, 0, z0)))
    return textured(join(parts), (0, 2))


def main():
    s = Scene("pool")
    s.material("mosaic", (1, 1, 1), lambert=True, maps=tiles().save(s.folder, "mosaic", normal=False), metres=1.0)
    s.material("travertine", (1, 1, 1), lambert=True, maps=stone().save(s.folder, "travertine", normal=False), metres=2.0)
    s.material("plaster", (0.76, 0.71, 0.63), lambert=True)
    s.material("timber", (0.36, 0.23, 0.13), lambert=True)
    s.material("terracotta", (0.62, 0.27, 0.15), lambert=True)
    s.material("water", (1, 1, 1), glass=0, ior=1.333, attenuation=((0.52, 0.86, 0.90), 3.0))
    s.material("globe", (0.8, 0.8, 0.8), lambert=True, emit=(1.0, 0.72, 0.42), strength=24)
    s.mesh("basin", [(basin(), "mosaic")])
    s.mesh("deck", [(deck(), "travertine")])
    s.mesh("water", [(water(), "water")])
    wall, high = -Z - 1.5, 2.75
    s.mesh("wall", [(box((-9, 0, wall - 0.3), (9, high, wall), skip="-y"), "plaster")])
    roof = [box((-9, high, wall - 0.3), (9, high + 0.12, wall + 3.2))]
    s.mesh("roof", [(join(roof), "plaster")])
    beams = [box((x - 0.07, high - 0.18, wall), (x + 0.07, high, wall + 3.1)) for x in np.arange(-8.1, 8.2, 1.35)]
    s.mesh("beams", [(join(beams), "timber")])
    s.mesh("globe", [(sphere(0.13, 48, 24), "globe")])
    pot = sphere(0.26, 48, 24)
    s.mesh("pot", [(pot, "terracotta")])
    for name in ("basin", "deck", "water", "wall", "roof", "beams"):
        s.place(name)
    s.place("globe", (-2.5, 0.55, wall + 0.45))
    s.mesh("post", [(box((-0.025, 0, -0.025), (0.025, 0.44, 0.025)), "timber")])
    s.place("post", (-2.5, 0, wall + 0.45))
    s.place("pot", (2.9, 0.24, wall + 0.55))
    hdr(os.path.join(s.folder, "sky.hdr"), textures.sky(128, -SUN))
    s.sun("sun", SUN, (1.0, 0.87, 0.70), 7.5)
    s.camera("main", (0.7, 1.45, 3.0), (-0.25, 0.42, -2.6), yfov=52)
    s.camera("below", (2.9, -0.85, 1.7), (-2.0, -0.75, -1.6), yfov=60)
    s.write("A tiled basin with waves under a low sun, and a globe lamp by the wall: caustics on the shaded wall and roof "
            "above, and on the tiles below, seen through the water that makes them.",
            {"film.ev": -0.35, "components.secondary": "cache", "components.tertiary": "photons",
             "components.caustic": "photons", "environment": {"file": "sky.hdr", "scale": 0.22}})


if __name__ == "__main__":
    main()
