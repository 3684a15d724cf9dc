"""Furniture and small things: each function returns a Mesh, or several for several materials, standing on y = 0 and
facing +z, in metres."""
import numpy as np

from gltf import join
from shapes import box, chamfer, facing, grid, lathe, rotate, superquadric, sweep, translate


def leg(at, foot, radius, height, low=0.0, segments=10):
    """A round leg from (x, z) `foot` on the floor to (x, z) `at` at `height`, drawing in downwards by half."""
    a, b = np.array([foot[0], low, foot[1]]), np.array([at[0], height, at[1]])
    t = np.linspace(0, 1, 3)[:, None]
    phi = 2 * np.pi * np.arange(segments + 1) / segments
    ring = np.stack([np.sin(phi), 0 * phi, np.cos(phi)], 1)
    ring[-1] = ring[0]
    r = radius * (0.62 + 0.38 * t)
    p = (a + (b - a) * t)[:, None, :] + r[:, :, None] * ring[None]
    n = np.repeat(ring[None], 3, 0)
    tube = facing(grid(p, n.reshape(-1, 3)))
    return tube


def bar(a, b, radius, segments=8):
    """A round bar between two points, open ends."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    d = b - a
    length = np.linalg.norm(d)
    d /= length
    side = np.cross(d, (0, 1, 0) if abs(d[1]) < 0.9 else (1, 0, 0))
    side /= np.linalg.norm(side)
    up = np.cross(d, side)
    phi = 2 * np.pi * np.arange(segments + 1) / segments
    ring = np.cos(phi)[:, None] * side + np.sin(phi)[:, None] * up
    ring[-1] = ring[0]
    p = np.stack([a + radius * ring, b + radius * ring])
    return facing(grid(p, np.concatenate([ring, ring])))


def tube(points, radius, segments=8, bend=0.05, steps=5):
    """A bent steel tube along points, its corners rounded by `bend`."""
    pts = [np.asarray(p, float) for p in points]
    path = [pts[0]]
    for a, b, c in zip(pts, pts[1:], pts[2:]):
        u, v = (a - b) / np.linalg.norm(a - b), (c - b) / np.linalg.norm(c - b)
        r = min(bend, 0.45 * np.linalg.norm(a - b), 0.45 * np.linalg.norm(c - b))
        for t in np.linspace(0, 1, steps + 1):
            path.append(b + r * (u * (1 - t) ** 2 + v * t ** 2))
    path.append(pts[-1])
    path = np.array(path)
    d = np.gradient(path, axis=0)
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    side = np.zeros_like(d)
    first = np.cross(d[0], (0, 1, 0) if abs(d[0][1]) < 0.9 else (1, 0, 0))
    side[0] = first / np.linalg.norm(first)
    for k in range(1, len(d)):
        v = side[k - 1] - d[k] * (side[k - 1] @ d[k])
        side[k] = v / np.linalg.norm(v)
    up = np.cross(d, side)
    phi = 2 * np.pi * np.arange(segments + 1) / segments
    ring = np.cos(phi)[None, :, None] * side[:, None] + np.sin(phi)[None, :, None] * up[:, None]
    ring[:, -1] = ring[:, 0]
    return facing(grid(path[:, None] + radius * ring, ring.reshape(-1, 3)))


# ---- seats and tables ----------------------------------------------------------------------------------------------
def wooden_chair():
    """A kitchen chair: (wood) 0.45 m wide, seat at 0.45 m, back with three slats at 0.86 m; it faces +z."""
    parts = [chamfer((-0.215, 0.425, -0.20), (0.215, 0.450, 0.215), 0.009)]
    for x in (-1, 1):
        parts.append(leg((x * 0.185, 0.185), (x * 0.195, 0.20), 0.021, 0.43))
        parts.append(leg((x * 0.18, -0.17), (x * 0.19, -0.215), 0.021, 0.43))
        parts.append(bar((x * 0.188, 0.20, 0.19), (x * 0.185, 0.18, -0.195), 0.010))
        lean = np.array([(x * 0.18, 0.43, -0.175), (x * 0.19, 0.66, -0.205), (x * 0.195, 0.875, -0.255)])
        parts.append(tube(lean, 0.0155, 10, 0.12))
    parts.append(bar((-0.19, 0.26, 0.188), (0.19, 0.26, 0.188), 0.010))
    parts.append(bar((-0.186, 0.20, 0.0), (0.186, 0.20, 0.0), 0.009))
    for y, z, high in ((0.60, -0.197, 0.040), (0.715, -0.218, 0.040), (0.835, -0.245, 0.062)):
        x = np.linspace(-0.19, 0.19, 9)
        curve = z - 0.022 * (1 - (x / 0.19) ** 2)
        path = np.stack([x, np.full_like(x, y), curve], 1)
        h, t = high / 2, 0.007
        frames = (np.tile([0.0, 1, 0], (9, 1)), np.tile([0.0, 0, 1], (9, 1)))
        profile = [(-h, -t), (-h, t), (h, t), (h, -t), (-h, -t)]
        parts.append(sweep(profile, path, frames, smooth=20))
    return join(parts)


def table(width, depth, height, top=0.028, leg_size=0.055, apron=0.08, edge=0.005):
    """A table with square tapering legs and an apron."""
    w, d = width / 2, depth / 2
    parts = [chamfer((-w, height - top, -d), (w, height, d), edge)]
    i = 0.035
    for x in (-1, 1):
        for z in (-1, 1):
            parts.append(chamfer((x * (w - i), -0.001, z * (d - i)),
                                 (x * (w - i - leg_size), height - top + 0.002, z * (d - i - leg_size)), 0.004))
    y0, y1 = height - top - apron, height - top + 0.001
    parts += [chamfer((-w + i + leg_size - 0.01, y0, z * (d - i - 0.012)), (w - i - leg_size + 0.01, y1,
                                                                          z * (d - i - 0.032)), 0.003) for z in (-1, 1)]
    parts += [chamfer((x * (w - i - 0.012), y0, -d + i + leg_size - 0.01), (x * (w - i - 0.032), y1,
                                                                          d - i - leg_size + 0.01), 0.003)
              for x in (-1, 1)]
    return join(parts)


def round_table(radius=0.40, height=0.72):
    """A pedestal table: turned top, column and foot."""
    r, h = radius, height
    return lathe([(0, 0.0), (0.20, 0.0), (0.215, 0.008), (0.21, 0.022), (0.10, 0.040), (0.045, 0.075), (0.035, 0.14),
                  (0.042, 0.28), (0.052, 0.36), (0.038, 0.44), (0.034, 0.56), (0.05, h - 0.075), (0.11, h - 0.040),
                  (0.13, h - 0.028), (r - 0.012, h - 0.028), (r - 0.003, h - 0.022), (r, h - 0.012),
                  (r - 0.004, h - 0.003),
                  (r - 0.012, h), (0, h)], 56, smooth=40)


def pillow(size=0.45, thick=0.075):
    """A square cushion lying on its back, about its middle."""
    m = superquadric((size / 2, thick, size / 2), 0.30, 1.0, 48, 16)
    return m


def rug(width, depth, thick=0.012, border=0.10):
    """(field, border) of a rug about the origin."""
    w, d = width / 2, depth / 2
    outer = chamfer((-w, -0.001, -d), (w, thick, d), 0.005)
    field = chamfer((-w + border, 0.002, -d + border), (w - border, thick + 0.0015, d - border), 0.001)
    return field, outer


# ---- shelves, books, plants ----------------------------------------------------------------------------------------
def bookcase(width, height, depth, shelves, board=0.022):
    """A bookcase with its back at z = 0; and the heights of what stands on its shelves (case, heights)."""
    w = width / 2
    parts = [chamfer((-w, -0.001, 0.002), (-w + board, height, depth), 0.002),
             chamfer((w - board, -0.001, 0.002), (w, height, depth), 0.002),
             box((-w + board - 0.004, 0.05, 0.003), (w - board + 0.004, height - 0.004, 0.011))]
    levels = [0.06 + (height - 0.06 - board) * k / shelves for k in range(shelves + 1)]
    for y in levels:
        parts.append(chamfer((-w + board - 0.003, y, 0.004), (w - board + 0.003, y + board, depth - 0.006), 0.002))
    parts.append(box((-w + board - 0.003, -0.001, depth - 0.05), (w - board + 0.003, 0.065, depth - 0.03)))
    return join(parts), [y + board for y in levels[:-1]]


def book(thick, high, deep):
    """(cover, pages) of a book standing, its spine towards +z, its foot's middle at the origin."""
    t = thick / 2
    cover = [box((-t, 0, -deep), (-t + 0.002, high, 0)), box((t - 0.002, 0, -deep), (t, high, 0)),
             chamfer((-t + 0.0005, 0.0004, -0.006), (t - 0.0005, high - 0.0004, 0.003), 0.0025)]
    return join(cover), box((-t + 0.002, 0.003, -deep + 0.004), (t - 0.002, high - 0.003, -0.005), "-x +x")


def row_of_books(rs, length, high, deep, tones, lean=True):
    """Books side by side from x = 0 to `length`: ({tone: covers}, pages)."""
    covers, pages, x = {}, [], 0.0
    while True:
        t = rs.uniform(0.014, 0.045)
        if x + t > length:
            break
        h, d = high * rs.uniform(0.72, 0.97), deep * rs.uniform(0.72, 0.95)
        c, p = book(t, h, d)
        m = translate(x + t / 2, -0.0008, -deep * 0.02 - rs.uniform(0, 0.02))
        tone = tones[rs.randint(len(tones))]
        covers.setdefault(tone, []).append(c.moved(m))
        pages.append(p.moved(m))
        x += t + 0.0008
        if lean and rs.uniform() < 0.06:
            x += rs.uniform(0.03, 0.10)
    return {k: join(v) for k, v in covers.items()}, join(pages)


def flat_book(width, high, deep):
    """(cover, pages) of a book lying, its spine towards -x."""
    w, d = width / 2, deep / 2
    cover = [chamfer((-w, 0, -d), (w, 0.0025, d), 0.001), chamfer((-w, high - 0.0025, -d), (w, high, d), 0.001),
             box((-w - 0.002, 0.0005, -d + 0.0004), (-w + 0.002, high - 0.0005, d - 0.0004))]
    return join(cover), box((-w + 0.001, 0.002, -d + 0.004), (w - 0.004, high - 0.002, d - 0.004), "+y -y")


def leaf(length, width, droop, along=8, lift=0.9, fold=0.25):
    """One leaf from the origin out along +z and up, bending down; double-sided."""
    t = np.linspace(0, 1, along + 1)[:, None]
    u = np.linspace(-1, 1, 5)[None, :]
    half = width / 2 * np.sin(np.pi * t ** 0.75) ** 0.8
    half[-1] = 0
    z = length * (t - 0.22 * droop * t * t) + 0 * u
    y = length * (lift * t - droop * t ** 2) + fold * half * np.abs(u)
    return grid(np.stack([half * u, y, z], 2))


def plant(rs, count, length, width, droop=0.75, stem=0.0, spread=(0.45, 1.0)):
    """A tuft of leaves about the origin: those inside stand up, those outside bend over. stem: the height over which the
    leaves' feet are spread."""
    parts = []
    for k in range(count):
        s = (k + 0.5) / count
        size = length * rs.uniform(0.75, 1.1)
        reach = spread[0] + (spread[1] - spread[0]) * s
        m = leaf(size * reach, width * rs.uniform(0.8, 1.15), droop * (0.35 + 0.75 * s), lift=1.55 - 1.0 * s)
        parts.append(m.moved(translate(0, stem * (1 - s) * rs.uniform(0.8, 1.0), 0) @ rotate("y", 137.5 * k) @
                             translate(0, 0, 0.008)))
    return join(parts)


def pot(radius, height, wall=0.008):
    """(pot, soil) of a plant pot."""
    r, h = radius, height
    outside = lathe([(0, 0), (0.72 * r, 0), (0.74 * r, 0.004), (0.95 * r, h - 0.035), (r, h - 0.033),
                     (1.02 * r, h - 0.004),
                     (1.01 * r, h), (0.93 * r, h), (0.90 * r, h - 0.05)], 40)
    soil = lathe([(0.93 * r, h - 0.035), (0.5 * r, h - 0.026), (0, h - 0.022)], 32)
    return outside, soil


def vase(height=0.26):
    k = height / 0.26
    p = [(0, 0), (0.042, 0), (0.046, 0.004), (0.062, 0.05), (0.074, 0.10), (0.072, 0.14), (0.052, 0.19), (0.030, 0.22),
         (0.026, 0.235), (0.036, 0.258), (0.035, 0.26), (0.031, 0.259), (0.022, 0.235), (0.026, 0.21), (0.045, 0.18),
         (0.064, 0.13), (0.0, 0.05)]
    return lathe([(r * k, y * k) for r, y in p], 48, smooth=50)


def bowl(radius=0.13, height=0.07):
    t = np.linspace(0, 1, 9)
    outer = [(0.05 * radius / 0.13 + (radius - 0.05 * radius / 0.13) * a ** 0.6, 0.008 + (height - 0.008) * a ** 1.5)
             for a in t]
    inner = [(r - 0.006, y + 0.004) for r, y in outer[::-1]]
    foot = [(0, 0.002), (0.045 * radius / 0.13, 0.0), (0.05 * radius / 0.13, 0.003)]
    return lathe(foot + outer + [(radius - 0.003, height + 0.003)] + inner[1:] + [(0, 0.012)], 40, smooth=50)


def mug(radius=0.040, height=0.092):
    """A mug with its handle towards +x."""
    r, h = radius, height
    cup = lathe([(0, 0.002), (r - 0.006, 0.0), (r - 0.001, 0.004), (r, 0.012), (r, h - 0.002), (r - 0.001, h),
                 (r - 0.0035, h - 0.001), (r - 0.004, 0.01), (0, 0.007)], 32)
    ear = tube([(r - 0.002, h * 0.80, 0), (r + 0.028, h * 0.82, 0), (r + 0.026, h * 0.26, 0), (r - 0.002, h * 0.22, 0)],
               0.0045, 8, 0.022)
    return join([cup, ear])


def pencil(length=0.175, radius=0.0036):
    """(body, point) of a six-sided pencil lying along x."""
    body = lathe([(0, 0), (radius, 0), (radius, length - 0.02)], 6, smooth=10)
    tip = lathe([(radius, length - 0.02), (0.0, length)], 6)
    m = translate(-length / 2, radius * 0.86, 0) @ rotate("z", -90)
    return body.moved(m), tip.moved(m)


def desk_lamp():
    """(metal, shade) of a jointed lamp."""
    metal = [lathe([(0, 0), (0.085, 0), (0.09, 0.006), (0.086, 0.016), (0.02, 0.022), (0.012, 0.03), (0.012, 0.05),
                    (0, 0.052)], 32),
             bar((0, 0.04, 0), (-0.11, 0.34, 0), 0.007), bar((-0.11, 0.34, 0), (0.13, 0.50, 0), 0.007),
             superquadric((0.014, 0.014, 0.014), 1, 1, 12, 8).moved(translate(-0.11, 0.34, 0))]
    shade = lathe([(0.078, -0.002), (0.080, 0.0), (0.058, 0.07), (0.030, 0.095), (0.0, 0.10), (0.0, 0.097),
                   (0.028, 0.092), (0.055, 0.068), (0.078, -0.002)], 32).moved(
        translate(0.155, 0.425, 0) @ rotate("z", 18))
    return join(metal), shade
