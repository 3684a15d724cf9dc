"""A small gallery in the evening (`gallery`): one wall, and a lamp of every kind at what it does best.

From left to right: a globe of opal glass, a picture light (tube) over a painting, a spot on a bronze, a light box
(rectangle) in the ceiling, a wall disk whose light grazes the plaster, two downlights with a measured distribution, a
leaning tube, a candle (point), and late sun through a slot.
"""
import os

import numpy as np

import textures
from furniture import bar
from gltf import Scene, join
from shapes import box, chamfer, disk, facing, grid, lathe, quad, rotate, sphere, translate
from textures import mix, noise, rgb, smooth

WIDTH, HEIGHT, DEPTH = 7.0, 3.1, 5.0  # of the room; the wall is at z = 0, its middle at x = 0


def materials(s):
    textures.png(os.path.join(s.folder, "plaster.png"), textures.to_srgb(textures.plaster(512).color))
    textures.png(os.path.join(s.folder, "wood.png"), textures.to_srgb(textures.wood(512).color))
    s.material("plaster", (0.86, 0.83, 0.79), lambert=True, maps={"color": "plaster.png"}, metres=(1.6, 1.6))
    s.material("ceiling", (0.78, 0.77, 0.75), lambert=True)
    s.material("floor", (0.30, 0.22, 0.155), rough=0.30, maps={"color": "wood.png"}, metres=(1.3, 1.3))
    s.material("oak", (0.55, 0.40, 0.27), rough=0.45, maps={"color": "wood.png"}, metres=(0.7, 0.7))
    s.material("black", (0.022, 0.022, 0.024), rough=0.35)
    s.material("brass", (0.86, 0.66, 0.36), rough=0.42, metal=1.0)
    s.material("bronze", (0.50, 0.32, 0.19), rough=0.38, metal=1.0)
    s.material("stone", (0.62, 0.60, 0.57), rough=0.65)
    s.material("linen", (0.80, 0.77, 0.70), lambert=True)
    s.material("wax", (0.85, 0.78, 0.64), lambert=True)
    for name, picture in (("sea", sea()), ("field", field())):
        textures.png(os.path.join(s.folder, name + ".png"), textures.to_srgb(picture))
        s.material(name, (1, 1, 1), rough=0.5, maps={"color": name + ".png"}, metres=(1, 1))


def sea(n=512):
    """A painted horizon: warm sky over dark water."""
    y = np.linspace(0, 1, n)[:, None] + 0 * np.zeros((1, n))
    clouds = noise((n, n), 41, 1.7, 2, 200, (1.0, 3.2))
    water = noise((n, n), 42, 1.2, 6, 250, (1.0, 7.0))
    sky = mix(rgb(0.16, 0.25, 0.36), rgb(0.90, 0.58, 0.30), smooth(y + 0.10 * clouds, 0.08, 0.56))
    glow = np.exp(-((y - 0.55) / 0.05) ** 2) * (0.6 + 0.25 * clouds)
    sky = sky + glow[..., None] * rgb(0.30, 0.16, 0.05)
    sea = mix(rgb(0.022, 0.050, 0.072), rgb(0.30, 0.24, 0.17), smooth(0.35 * water + 0.9 - 2.4 * (y - 0.55), 0.6, 1.5))
    return np.clip(np.where((y < 0.56)[..., None], sky, sea), 0.004, 0.95)


def field(n=512):
    """Two fields of colour with a soft border, on a third."""
    v, u = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    worn = noise((n, n), 51, 1.6, 2, 250)
    edge = 0.012 + 0.006 * noise((n, n), 52, 1.2, 8, 120)

    def patch(u0, u1, v0, v1):
        inside = np.minimum(np.minimum(u - u0, u1 - u), np.minimum(v - v0, v1 - v))
        return smooth(inside, -edge, edge) * (0.93 + 0.05 * worn)

    c = rgb(0.20, 0.045, 0.030) * (1 + 0.10 * worn[..., None])
    c = mix(c, rgb(0.78, 0.235, 0.045), np.clip(patch(0.08, 0.92, 0.07, 0.54), 0, 1))
    return np.clip(mix(c, rgb(0.055, 0.085, 0.115), np.clip(patch(0.08, 0.92, 0.60, 0.93), 0, 1)), 0.004, 0.95)


def room(s):
    x, d, h = WIDTH / 2, DEPTH, HEIGHT

    def metres(m, a, b):
        return m.with_uv(np.stack([m.p[:, a], m.p[:, b]], 1))

    wall = metres(quad((-x, 0, 0), (x, 0, 0), (x, h, 0), (-x, h, 0)), 0, 1)
    left = metres(quad((-x, 0, d), (-x, 0, 0), (-x, h, 0), (-x, h, d)), 2, 1)
    back = metres(quad((x, 0, d), (-x, 0, d), (-x, h, d), (x, h, d)), 0, 1)
    # The right wall has a slot for the sun, 0.32 m wide.
    y0, y1, z0, z1 = 0.9, 2.55, 1.95, 2.27
    right = [quad((x, a, q), (x, a, p), (x, b, p), (x, b, q))
             for a, b, p, q in ((0, h, 0, z0), (0, h, z1, d), (0, y0, z0, z1), (y1, h, z0, z1))]
    right = [metres(m.flipped() if m.n[0, 0] > 0 else m, 2, 1) for m in right]
    s.mesh("walls", [(join([wall, left, back] + right), "plaster")])
    s.mesh("slot", [(box((x, y0 - 0.3, z0 - 0.3), (x + 0.30, y1 + 0.3, z0)), "ceiling"),
                    (box((x, y0 - 0.3, z1), (x + 0.30, y1 + 0.3, z1 + 0.3)), "ceiling"),
                    (box((x, y1, z0), (x + 0.30, y1 + 0.3, z1)), "ceiling"),
                    (box((x, y0 - 0.3, z0), (x + 0.30, y0, z1)), "ceiling")])
    s.mesh("ceiling", [(quad((-x, h, 0), (x, h, 0), (x, h, d), (-x, h, d)), "ceiling")])
    floor = quad((-x, 0, d), (x, 0, d), (x, 0, 0), (-x, 0, 0))
    s.mesh("floor", [(floor.with_uv(np.stack([floor.p[:, 0], floor.p[:, 2]], 1)), "floor")])
    s.mesh("skirting", [(box((-x, 0, 0), (x, 0.07, 0.012)), "ceiling")])
    for name in ("walls", "slot", "ceiling", "floor", "skirting"):
        s.place(name)


def painting(s, name, width, height, x, y):
    """A picture in a thin black frame."""
    t, deep = 0.022, 0.045
    canvas = quad((-width / 2, -height / 2, 0.03), (width / 2, -height / 2, 0.03), (width / 2, height / 2, 0.03),
                  (-width / 2, height / 2, 0.03))
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float)
    w, h = width / 2, height / 2
    sides = [box((-w - t, h, 0), (w + t, h + t, deep)), box((-w - t, -h - t, 0), (w + t, -h, deep)),
             box((-w - t, -h, 0), (-w, h, deep)), box((w, -h, 0), (w + t, h, deep))]
    s.mesh(name + " picture", [(canvas.with_uv(uv[:len(canvas.p)]), name), (join(sides), "black")])
    s.place(name + " picture", (x, y, 0))


def bronze():
    """A slender turned figure."""
    return lathe([(0, 0), (0.085, 0), (0.085, 0.012), (0.030, 0.030), (0.020, 0.075), (0.050, 0.190), (0.074, 0.285),
                  (0.062, 0.365), (0.028, 0.420), (0.018, 0.452), (0.034, 0.490), (0.044, 0.530), (0.036, 0.575),
                  (0.014, 0.600), (0, 0.603)], 128, smooth=60)


def things(s):
    s.mesh("plinth", [(chamfer((-0.17, 0, -0.17), (0.17, 1.02, 0.17), 0.004), "stone")])
    s.place("plinth", (0.36, 0, 0.62), yaw=12)
    s.mesh("bronze figure", [(bronze(), "bronze")])
    s.place("bronze figure", (0.36, 1.02, 0.62))
    seat = chamfer((-0.80, 0.40, -0.20), (0.80, 0.45, 0.20), 0.006)
    seat = seat.with_uv(np.stack([seat.p[:, 2] + 0.3 * seat.p[:, 1], seat.p[:, 0]], 1))
    feet = [box((a - 0.02, 0, -0.17), (a + 0.02, 0.40, 0.17)) for a in (-0.66, 0.66)]
    s.mesh("bench", [(seat, "oak"), (join(feet), "black")])
    s.place("bench", (-1.05, 0, 1.75), yaw=4)
    # The globe's cord and cap, the picture light's arm, the disk's shade, the tube's socket, the candle.
    s.mesh("globe mount", [(join([bar((0, 0.150, 0), (0, HEIGHT - 1.98, 0), 0.004),
                                  lathe([(0, 0.185), (0.028, 0.185), (0.034, 0.150), (0.050, 0.138), (0, 0.138)], 48)]),
                            "brass")])
    s.place("globe mount", (-2.45, 1.98, 0.80))
    arm = [bar((x, 0, 0.0), (x, 0.055, 0.13), 0.005) for x in (-0.30, 0.30)]
    hood = []
    for a0, a1 in zip(np.linspace(20, 200, 13)[:-1], np.linspace(20, 200, 13)[1:]):
        p, q = ([0.028 * np.sin(np.radians(a)), 0.028 * np.cos(np.radians(a))] for a in (a0, a1))
        hood.append(quad((-0.45, p[0], -p[1]), (0.45, p[0], -p[1]), (0.45, q[0], -q[1]), (-0.45, q[0], -q[1])))
    hood = join(hood)
    s.mesh("picture light", [(join(arm), "brass"),
                             (join([hood, hood.flipped()]).moved(translate(0, 0.065, 0.155) @ rotate("x", -35)), "brass")])
    s.place("picture light", (-1.42, 2.235, 0.0))
    s.mesh("disk shade", [(lathe([(0, 0.050), (0.20, 0.050), (0.205, 0.045), (0.205, 0.040), (0, 0.040)], 128), "brass"),
                          (lathe([(0, 0), (0.03, 0), (0.03, 0.041), (0, 0.041)], 32), "brass")])
    s.place("disk shade", matrix=translate(1.22, 1.78, 0.03) @ rotate("x", 90))
    s.mesh("candle", [(lathe([(0, 0), (0.058, 0), (0.060, 0.006), (0.030, 0.010), (0.026, 0.020), (0, 0.021)], 64), "brass"),
                      (lathe([(0.0, 0.020), (0.020, 0.020), (0.0195, 0.165), (0.014, 0.168), (0, 0.164)], 48), "wax")])
    s.place("candle", (-1.52, 0.45, 1.76))
    s.mesh("box frame", [(join([box((-0.86, -0.06, -0.36), (0.86, 0, -0.33)), box((-0.86, -0.06, 0.33), (0.86, 0, 0.36)),
                                box((-0.86, -0.06, -0.33), (-0.83, 0, 0.33)), box((0.83, -0.06, -0.33), (0.86, 0, 0.33))]),
                          "black")])
    s.place("box frame", (0.9, HEIGHT, 2.6))
    s.mesh("tube end", [(join([bar((0, 0, 0), (0, 0.045, 0), 0.016, 24)]), "black")])


def scallop(file):
    """An LM-63 file: a reflector's bright core, a dark ring, and a skirt with an edge at 52 degrees."""
    polar = np.arange(0, 90.1, 2.5)
    core = 2600 / (1 + np.exp((polar - 17) / 2.2))
    skirt = 620 * np.exp(-((polar - 34) / 13.0) ** 2) / (1 + np.exp((polar - 52) / 1.3))
    candela = np.round(core + skirt, 1)
    rows = [candela[i:i + 10] for i in range(0, len(candela), 10)]
    with open(file, "w") as f:
        f.write("IES:LM-63-2019\n[TEST] none: made by scenes/generate/gallery.py\n[MANUFAC] Lucerna\n[LUMINAIRE] Downlight\n"
                f"TILT=NONE\n1 -1 1 {len(polar)} 1 1 2 -0.1 0 0\n1 1 12\n")
        f.write(" ".join(f"{a:g}" for a in polar) + "\n0\n")
        f.write("\n".join(" ".join(f"{v:g}" for v in row) for row in rows) + "\n")


def lamps(s):
    warm, soft, cool, rose = (1, 0.62, 0.30), (1, 0.78, 0.54), (0.78, 0.88, 1.0), (1, 0.36, 0.30)
    s.shaped("globe", (-2.45, 1.98, 0.80), (0, 0, -1), warm, 1.05, {"shape": "sphere", "radius": 0.15})
    s.shaped("picture tube", (-1.42, 2.300, 0.155), (0, -0.8, -0.6), soft, 1.5,
             {"shape": "tube", "length": 0.84, "radius": 0.009}, up=(0, 0.6, -0.8))
    s.spot("bronze spot", (0.75, HEIGHT - 0.02, 2.3), (-0.39, -1.72, -1.68), soft, 26, 5, 11)
    s.shaped("light box", (0.9, HEIGHT - 0.02, 2.6), (0, -1, 0), cool, 1.15,
             {"shape": "rectangle", "width": 1.66, "height": 0.66}, up=(0, 0, -1))
    s.shaped("wall disk", (1.22, 1.78, 0.062), (0, 0, -1), warm, 2.4, {"shape": "disk", "radius": 0.195})
    # It leans in the corner on the right.
    foot, top = np.array([2.62, 0.05, 0.45]), np.array([2.86, 2.42, 0.06])
    along = (top - foot) / np.linalg.norm(top - foot)
    across = np.cross(along, (0, 0, 1))
    s.shaped("leaning tube", 0.5 * (foot + top), np.cross(along, across), rose, 1.2,
             {"shape": "tube", "length": round(float(np.linalg.norm(top - foot)), 4), "radius": 0.018}, up=across)
    for p, way in ((foot, -1), (top, 1)):
        m = np.eye(4)
        y = way * along
        x = np.cross(y, (0, 0, 1))
        x /= np.linalg.norm(x)
        m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = x, y, np.cross(x, y), p
        s.place("tube end", matrix=m, name="tube end")
    scallop(os.path.join(s.folder, "downlight.ies"))
    for name, x in (("downlight", -0.42), ("picture downlight", 2.02)):
        s.fixture(name, (x, HEIGHT - 0.03, 0.34), (0, -1, 0), "downlight.ies", 0.0033, soft)
    s.point_lamp("candle", (-1.52, 0.645, 1.76), (1, 0.50, 0.16), 0.30)
    s.sun("sun", (-0.93, -0.20, -0.62), (1, 0.52, 0.22), 5.0)


def main():
    s = Scene("gallery")
    materials(s)
    room(s)
    painting(s, "sea", 1.25, 0.86, -1.42, 1.62)
    painting(s, "field", 0.80, 1.02, 2.02, 1.60)
    things(s)
    lamps(s)
    s.camera("main", (0.0, 1.50, 4.80), (0.0, 1.50, 0), yfov=40.5)
    s.extras = {"environment": {"radiance": [0.010, 0.016, 0.030]}}
    s.write("A small gallery in the evening: a lamp of every kind at what it does best. Globe, tubes, light box, wall disk, "
            "spot, downlights with a measured distribution, candle, and late sun through a slot.", {"film.ev": 0.0, "environment": {"radiance": [0.010, 0.016, 0.030]}})


if __name__ == "__main__":
    main()
