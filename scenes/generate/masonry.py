"""A corner of a courtyard in raking sun (`masonry`): hand-made bricks with raked joints, hammered plaster, tooled
flags, linen, and two balls of chalk on a bench.

The bricks are deep relief: one plane, whose joints hide and shadow themselves by a height texture. Plaster, flags and
linen are shallow relief, which only turns normals. The balls have one colour: the left one is Lambert's, the right one
rough, flat to its edge like the moon. x to the right, y up; the bricks face +z, the plaster on the right -x.
"""
import os

import numpy as np

import textures
from gltf import Scene, hdr, join, png
from shapes import box, chamfer, facing, grid, lathe, quad, rotate, sphere, translate
from textures import mix, noise, rgb, smooth

SUN = np.array([0.57, -0.70, -0.30])                 # along which it shines
RIGHT, LEFT, FRONT, HIGH = 1.62, -2.95, 6.6, 2.10    # faces of the walls; their height, 28 courses
COURSE, BOND = 0.075, 0.3375                         # a course; a stretcher and a header, with their joints
BRICKS = (3 * BOND, 14 * COURSE)                     # one repeat of the height texture
FLAGS, PLASTER, LINEN = (1.0, 1.0), (1.1, 1.1), (0.064, 0.064)


def grey(s, name, a):
    """Writes heights of 0 to 1 as an 8-bit picture."""
    png(os.path.join(s.folder, name), np.round(np.clip(a, 0, 1) * 255))
    return name


def bond(x, y, count, rows):
    """Flemish bond: the number of the brick at a point, and the metres from there to the middle of the next joint,
    along the wall and up."""
    row = np.floor(y / COURSE).astype(int)
    along = x + 0.5 * BOND * (row % 2)
    k = np.floor(along / BOND).astype(int)
    u = along - k * BOND
    cut = BOND * 2 / 3
    head = u > cut
    dx = np.where(head, np.minimum(u - cut, BOND - u), np.minimum(u, cut - u))
    v = y - row * COURSE
    return (row % rows) * 2 * count + 2 * (k % count) + head, dx, np.minimum(v, COURSE - v)


def bricks(s, n=1024):
    """Heights of one repeat, and colours of four of them, so that fewer bricks look alike."""
    shape = (n, n)
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n * np.array(BRICKS[::-1])[:, None, None]
    wander = 0.0011 * noise(shape, 1, 1.3, 3, 60), 0.0010 * noise(shape, 2, 1.3, 3, 60)
    which, dx, dy = bond(x + wander[0], y + wander[1], 3, 14)
    r = 0.009
    d = np.where((dx < r) & (dy < r), r - np.hypot(r - dx, r - dy), np.minimum(dx, dy))
    d = d + 0.0007 * noise(shape, 3, 0.9, 20, 200)
    face = smooth(d, 0.0042, 0.0072)
    rs = np.random.RandomState(4)
    drop, lean, tilt = 0.0011 * rs.rand(84), rs.uniform(-1, 1, 84), rs.uniform(-1, 1, 84)
    crease = smooth(noise(shape, 5, 1.1, 6, 90, (1.8, 1.0)), 0.9, 2.4)       # folds of the clay thrown into its mould
    pit = textures.pits(shape, 6, 1.9)
    level = 0.0112 - drop[which] - 0.0007 * np.abs(lean[which]) * smooth(lean[which] * (dy - 0.012), -0.02, 0.03)
    level = level - 0.0006 * np.abs(tilt[which]) * smooth(tilt[which] * (dx - 0.03), -0.05, 0.05)
    level = level + 0.00020 * noise(shape, 7, 0.8, 12, 260) - 0.0011 * crease - 0.0016 * pit
    level = level - 0.0012 * np.exp(-np.maximum(d - 0.005, 0) / 0.004)
    mortar = 0.0018 + 0.00030 * noise(shape, 8, 0.8, 8, 240)
    h = mortar + (level - mortar) * face
    file = grey(s, "bricks_height.png", h / 0.012)

    def four(a):
        a = a.reshape(n // 2, 2, n // 2, 2).mean((1, 3))
        return np.tile(a, (2, 2))

    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n * 2 * np.array(BRICKS[::-1])[:, None, None]
    which, _, _ = bond(x + four(wander[0]), y + four(wander[1]), 6, 28)
    rs = np.random.RandomState(9)
    tone, hue = rs.rand(336), rs.standard_normal(336)
    color = mix(rgb(0.300, 0.175, 0.128), rgb(0.440, 0.305, 0.228), tone[which])
    color = np.where((rs.rand(336) > 0.90)[which][..., None], color * rgb(0.68, 0.67, 0.72), color)
    color = color * (1 + 0.035 * hue[which][..., None] * rgb(1, 0, -1))
    cloud = np.round(noise(shape, 10, 1.5, 4, 90) * 4) / 4   # in steps too small to be seen: a smaller file
    color = color * (1 + 0.055 * cloud)[..., None]
    lime = 0.30 * smooth(np.round(noise(shape, 11, 1.6, 2, 40) * 8) / 8, 0.6, 2.6)
    color = mix(color, rgb(0.50, 0.455, 0.395), lime)
    color = mix(rgb(0.375, 0.345, 0.300) * (1 + 0.03 * cloud)[..., None], color, four(face))
    png(os.path.join(s.folder, "bricks_color.png"), textures.to_srgb(color))
    return file


def flags(s, n=512):
    """Stone flags of 50 cm: heights of 2 x 2 of them, tooled by hand one way and the other; colours of 4 x 4."""
    shape = (n, n)
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n
    wx, wy = x + 0.0012 * noise(shape, 21, 1.4, 2, 30), y + 0.0012 * noise(shape, 22, 1.4, 2, 30)
    i, j = np.floor(wy * 2).astype(int) % 2, np.floor(wx * 2).astype(int) % 2
    u, v = wx * 2 % 1, wy * 2 % 1
    d = 0.5 * np.minimum(np.minimum(u, 1 - u), np.minimum(v, 1 - v))
    d = np.maximum(d + 0.0006 * noise(shape, 23, 0.9, 20, 160), 0)
    down, across = noise(shape, 24, 0.2, 24, 80, (9.0, 1.0)), noise(shape, 25, 0.2, 24, 80, (1.0, 9.0))
    lines = np.where((i + j) % 2 == 0, down, across)
    worn = smooth(d, 0.012, 0.045) * (0.55 + 0.45 * smooth(noise(shape, 26, 1.5, 2, 16), -1, 1))
    h = 0.0042 + 0.00050 * lines * worn + 0.0006 * noise(shape, 27, 1.8, 2, 24)
    h = h - 0.0016 * np.exp(-d / 0.009) - 0.0026 * (1 - smooth(d, 0.0025, 0.0065))
    file = grey(s, "flags_height.png", h / 0.006)
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n * 4
    rs = np.random.RandomState(28)
    tone, hue = rs.standard_normal((4, 4)), rs.standard_normal((4, 4))
    cell = y.astype(int), x.astype(int)
    color = rgb(0.34, 0.32, 0.285) * (1 + 0.075 * tone[cell])[..., None]
    color = color * (1 + 0.02 * hue[cell][..., None] * rgb(1, 0, -1))
    color = color * (1 + 0.035 * np.round(noise(shape, 29, 1.2, 3, 120) * 8) / 8)[..., None]
    joint = smooth(np.minimum(np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1)), 0.006, 0.014)
    color = mix(color * 0.62, color, joint)
    png(os.path.join(s.folder, "flags_color.png"), textures.to_srgb(color))
    return file


def hammered(s, n=512):
    """Plaster beaten with the edge of a trowel: soft overlapping dents, each the bed of one blow."""
    rs = np.random.RandomState(31)
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n
    h = np.full((n, n), 1.0)
    for _ in range(620):
        cx, cy, a = rs.rand(), rs.rand(), rs.normal(0.5, 0.35)
        long, short, deep = rs.uniform(0.045, 0.075), rs.uniform(0.026, 0.042), rs.uniform(0.4, 1.0)
        ux, uy = (x - cx + 0.5) % 1 - 0.5, (y - cy + 0.5) % 1 - 0.5
        p, q = np.cos(a) * ux + np.sin(a) * uy, np.cos(a) * uy - np.sin(a) * ux
        bed = (p / long) ** 2 + (q / short) ** 2
        h = np.minimum(h, 1 - deep * (1 - bed))
    f = np.fft.fftfreq(n) * n / 70
    h = np.fft.ifft2(np.fft.fft2(h) * np.exp(-0.5 * (f[:, None] ** 2 + f[None, :] ** 2))).real
    h = h - h.min()
    return grey(s, "plaster_height.png", 0.97 * h / h.max() + 0.008 * noise((n, n), 32, 0.6, 20, 200))


def linen(s, n=128):
    """A plain weave of 16 x 16 coarse threads."""
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n * 16
    over = (np.floor(x) + np.floor(y)) % 2 == 0
    warp, weft = np.abs(np.sin(np.pi * x)) ** 0.6, np.abs(np.sin(np.pi * y)) ** 0.6
    h = np.where(over, warp * (0.45 + 0.55 * weft), weft * (0.45 + 0.55 * warp))
    return grey(s, "linen_height.png", h * (0.9 + 0.05 * noise((n, n), 41, 0.6, 2, 30)))


def materials(s):
    white = (1, 1, 1)
    file = bricks(s)
    s.material("bricks", white, lambert=True, maps={"color": "bricks_color.png"}, metres=(2 * BRICKS[0], 2 * BRICKS[1]),
               relief=(file, BRICKS, 0.012, True), diffuse_rough=0.5)
    s.material("flags", white, lambert=True, relief=(flags(s), FLAGS, 0.010, False), diffuse_rough=0.3,
               maps={"color": "flags_color.png"}, metres=(2 * FLAGS[0], 2 * FLAGS[1]))
    s.material("plaster", (0.43, 0.405, 0.36), lambert=True, relief=(hammered(s), PLASTER, 0.008, False),
               diffuse_rough=0.4)
    s.material("linen", (0.50, 0.47, 0.41), lambert=True, relief=(linen(s), LINEN, 0.0016, False), diffuse_rough=0.6)
    s.material("plain plaster", (0.43, 0.405, 0.36), lambert=True)
    s.material("limestone", (0.46, 0.43, 0.375), lambert=True, diffuse_rough=0.4)
    s.material("basalt", (0.145, 0.145, 0.142), lambert=True, diffuse_rough=0.4)
    s.material("smooth chalk", (0.58, 0.56, 0.52), lambert=True, diffuse_rough=0)
    s.material("rough chalk", (0.58, 0.56, 0.52), lambert=True, diffuse_rough=1)
    s.material("terracotta", (0.42, 0.235, 0.160), lambert=True, diffuse_rough=0.8)
    s.material("soil", (0.06, 0.045, 0.035), lambert=True)


def jar(high=0.74):
    """An oil jar: narrow foot, full shoulder, rolled lip; faint rings of the wheel."""
    at = np.array([0, 0.10, 0.28, 0.50, 0.68, 0.80, 0.88, 0.92])
    radius = np.array([0.120, 0.155, 0.215, 0.260, 0.256, 0.210, 0.152, 0.128])
    t = np.linspace(0, 0.92, 100)
    rings = 0.0011 * np.sin(2 * np.pi * t / 0.066) * np.sin(np.pi * t / 0.92)
    r = np.polyval(np.polyfit(at, radius, 6), t) + rings
    body = [(0, 0), (r[0] - 0.012, 0)] + list(zip(r, t * high))[1:]
    end, y = r[-1], 0.92 * high
    lip = [(end + 0.016 + 0.020 * np.sin(a), y + 0.022 - 0.020 * np.cos(a)) for a in np.linspace(0.4, np.pi, 12)]
    inside = [(end - 0.012, y + 0.030), (end - 0.020, y), (end, y - 0.10), (0, y - 0.10)]
    return lathe(body + lip + inside, 80, smooth=40)


def cushion(half=0.235, thick=0.085):
    """A filled square of linen: its corners stand out, its sides are drawn in. uv in metres."""
    a = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 41))
    a, b = np.meshgrid(a, a)
    x, z = half * a * (1 - 0.09 * (1 - b * b)), half * b * (1 - 0.09 * (1 - a * a))
    fold = 1 + 0.05 * np.sin(5 * a + 2 * b) * a * a + 0.04 * np.sin(6 * b - 3 * a) * b * b
    y = thick * np.sqrt(np.sqrt((1 - a * a) * (1 - b * b)) * (0.3 + 0.7 * (1 - a * a) * (1 - b * b))) * fold
    uv = np.stack([x, z], 2).reshape(-1, 2)
    upper, lower = grid(np.stack([x, y, z], 2), uv=uv), grid(np.stack([x, -y, z], 2), uv=uv).flipped()
    if upper.n[len(upper.n) // 2, 1] < 0:
        upper, lower = upper.flipped(), lower.flipped()
    return facing(join([upper, lower]), (0, 0, 0))


def walls(s):
    x0, x1, z1 = LEFT, RIGHT, FRONT
    front = quad((x0, 0, 0), (x1, 0, 0), (x1, HIGH, 0), (x0, HIGH, 0))
    s.mesh("brick wall", [(front.with_uv(front.p[:, [0, 1]] * (1, -1)), "bricks"),
                          (box((x0 - 0.3, 0, -0.3), (x1 + 0.3, HIGH, 0), "+z"), "plain plaster")])
    side = quad((x1, 0, 0), (x1, 0, z1), (x1, HIGH, z1), (x1, HIGH, 0))
    s.mesh("plastered wall", [(side.with_uv(side.p[:, [2, 1]] * (1, -1)), "plaster"),
                              (box((x1, 0, 0), (x1 + 0.3, HIGH, z1), "-x"), "plain plaster")])
    others = [box((x0 - 0.3, 0, 0), (x0, 2.45, z1)), box((x0 - 0.3, 0, z1), (x1 + 0.3, HIGH, z1 + 0.3))]
    s.mesh("other walls", [(join(others), "plain plaster")])
    ground = quad((x0, 0, z1), (x1, 0, z1), (x1, 0, 0), (x0, 0, 0))
    s.mesh("floor", [(ground.with_uv(ground.p[:, [0, 2]] + (0.17, 0.0)), "flags")])
    stones = []
    for k, x in enumerate(np.arange(x0 - 0.3, x1 + 0.2, 0.86)):
        stones.append(chamfer((x + 0.002, HIGH, -0.34), (min(x + 0.858, x1 + 0.34), HIGH + 0.055, 0.045), 0.006))
    for z in np.arange(0.049, z1, 0.86):
        stones.append(chamfer((x1 - 0.045, HIGH, z), (x1 + 0.34, HIGH + 0.055, z + 0.856), 0.006))
    s.mesh("coping", [(join(stones), "limestone")])
    for name in ("brick wall", "plastered wall", "other walls", "floor", "coping"):
        s.place(name)


def main():
    s = Scene("masonry")
    materials(s)
    walls(s)
    seat = 0.44
    s.mesh("bench", [(join([chamfer((-1.62, seat - 0.085, 0.05), (0.62, seat, 0.50), 0.008),
                            chamfer((-1.42, 0, 0.09), (-1.20, seat - 0.084, 0.46), 0.008),
                            chamfer((0.20, 0, 0.09), (0.42, seat - 0.084, 0.46), 0.008)]), "basalt")])
    s.place("bench")
    ball = sphere(0.19, 96, 48)
    s.mesh("smooth ball", [(ball, "smooth chalk")])
    s.mesh("rough ball", [(ball, "rough chalk")])
    s.place("smooth ball", (-0.22, seat + 0.19, 0.275))
    s.place("rough ball", (0.30, seat + 0.19, 0.275))
    s.mesh("cushion", [(cushion(), "linen")])
    s.place("cushion", matrix=translate(-0.95, seat + 0.213, 0.185) @ rotate("z", 3) @ rotate("x", 72))
    s.mesh("jar", [(jar(), "terracotta")])
    s.place("jar", (1.17, 0, 0.60))
    hdr(os.path.join(s.folder, "sky.hdr"), textures.sky(128, -SUN))
    s.sun("sun", SUN, (1.0, 0.87, 0.70), 9.0)
    s.camera("main", (-0.44, 1.50, 4.9), (-0.44, 1.50, 0), yfov=31)
    s.cameras[-1]["extras"] = {"lucerna": {"shift_up": -0.19, "shift_right": 0.04}}
    s.camera("close", (1.00, 0.92, 1.55), (0.02, 0.72, 0.1), yfov=36)
    s.write("A courtyard's corner in raking sun: bricks with raked joints as deep relief, hammered plaster, tooled "
            "flags and linen as shallow relief, a smooth and a rough ball of chalk, and a terracotta jar.",
            {"film.ev": -0.1, "environment": {"file": "sky.hdr", "scale": 0.8}})


if __name__ == "__main__":
    main()
