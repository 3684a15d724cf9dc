"""What grows, flows and lies outside: orange trees, vines, water, the terrace behind the far arch, cypresses, hills."""
import numpy as np

from gltf import Mesh, join
from shapes import box, grid, lathe, quad, sphere, translate


def cypress(height, radius, seed, around=20, along=26):
    """A dense flame-shaped crown whose surface is broken into tufts; stands at the origin."""
    rs = np.random.RandomState(seed)
    t = np.linspace(0, 1, along + 1)
    shape = np.sin(np.pi * np.clip(t, 0.02, 1) ** 0.62) ** 0.75
    phi = 2 * np.pi * np.arange(around + 1) / around
    tuft = 1 + 0.16 * rs.standard_normal((along + 1, around + 1))
    tuft[:, -1] = tuft[:, 0]
    r = radius * shape[:, None] * tuft
    y = height * (0.05 + 0.95 * t)[:, None] + 0.10 * rs.standard_normal((along + 1, 1)) + 0 * r
    p = np.stack([r * np.sin(phi), y, r * np.cos(phi)], 2)
    return grid(p, None, None, close=True).flipped()


def hills(distance, half, seed, height, n=48):
    """A wooded ridge as a wall of varying height across the view, at z = -distance."""
    rs = np.random.RandomState(seed)
    x = np.linspace(-half, half, n + 1)
    top = np.zeros_like(x)
    for k in range(1, 7):
        top += rs.uniform(-1, 1) * np.sin(k * 2.3 * x / half + rs.uniform(0, 6.3)) / k
    top = height * (1 + 0.35 * top) + 0.05 * height * rs.standard_normal(n + 1)
    p = np.stack([np.stack([x, 0 * x - 0.5, 0 * x - distance], 1), np.stack([x, top, 0 * x - distance - 2], 1)])
    m = grid(p[::-1])
    return m if m.n[0, 2] > 0 else m.flipped()


def leaf_ball(radius, count, seed, size=0.085):
    """Leaves about a ball, most of them near its skin, each a bent pair of quads along its midrib."""
    rs = np.random.RandomState(seed)
    parts_p, parts_n, parts_t, base = [], [], [], 0
    for _ in range(count):
        d = rs.standard_normal(3)
        d /= np.linalg.norm(d)
        lumps = 1 + 0.13 * np.sin(5.1 * d[0] + seed) * np.sin(4.3 * d[1] + 2) + 0.10 * np.sin(7 * d[2] + 1)
        at = d * radius * lumps * rs.uniform(0.55, 1.0) ** 0.4
        axis = d + 0.9 * rs.standard_normal(3) + [0, 0.25, 0]
        axis /= np.linalg.norm(axis)
        side = np.cross(axis, d + 0.5 * rs.standard_normal(3))
        side /= np.linalg.norm(side)
        up = np.cross(side, axis)
        l, w = size * rs.uniform(0.7, 1.25), size * rs.uniform(0.2, 0.3)
        tip, root = at + axis * l - up * 0.15 * l, at
        mid = at + axis * 0.45 * l
        p = [root, mid + side * w + up * 0.3 * w, tip, mid - side * w + up * 0.3 * w]
        n1 = np.cross(p[1] - p[0], p[2] - p[0])
        n2 = np.cross(p[2] - p[0], p[3] - p[0])
        n1, n2 = n1 / np.linalg.norm(n1), n2 / np.linalg.norm(n2)
        parts_p += [p[0], p[1], p[2], p[0], p[2], p[3]]
        parts_n += [n1, n1, n1, n2, n2, n2]
        parts_t += [[base, base + 1, base + 2], [base + 3, base + 4, base + 5]]
        base += 6
    return Mesh(parts_p, parts_n, None, parts_t)


def vine(width, drop, strands, leaves, seed, size=0.075):
    """Strands of leaves that spill over a rail along x (its top at y = 0, its face to +z) and hang down unevenly."""
    rs = np.random.RandomState(seed)
    p, n, t = [], [], []
    share = rs.dirichlet(np.full(strands, 1.6)) * leaves
    for k in range(strands):
        x0 = width * (rs.uniform(-0.5, 0.5) + rs.uniform(-0.5, 0.5)) / 1.4
        length = drop * rs.uniform(0.35, 1.0) * (1 - (1.6 * x0 / width) ** 2 * 0.5)
        phase = rs.uniform(0, 6.3)
        for _ in range(max(int(share[k]), 6)):
            v = rs.uniform(-0.12, 1.0)
            y = -length * v
            at = np.array([x0 + 0.10 * np.sin(3.0 * v * length + phase), y, 0.17 + 0.05 * np.sin(2.2 * v + phase)])
            if v < 0:   # over the rail
                at[1], at[2] = 0.03, 0.16 + v * 1.6
            at += rs.standard_normal(3) * [0.05, 0.04, 0.035]
            axis = np.array([0, -0.7, 0.45]) + 0.6 * rs.standard_normal(3)
            axis /= np.linalg.norm(axis)
            side = np.cross(axis, [0, 0.3, 1] + 0.5 * rs.standard_normal(3))
            side /= np.linalg.norm(side)
            up = np.cross(side, axis)
            l, w = size * rs.uniform(0.6, 1.2), size * rs.uniform(0.28, 0.42)
            mid = at + 0.4 * l * axis + 0.3 * w * up
            q = [at, mid + side * w, at + axis * l, mid - side * w]
            base = len(p)
            for tri in ((q[0], q[1], q[2]), (q[0], q[2], q[3])):
                normal = np.cross(tri[1] - tri[0], tri[2] - tri[0])
                p += list(tri)
                n += [normal / np.linalg.norm(normal)] * 3
            t += [[base, base + 1, base + 2], [base + 3, base + 4, base + 5]]
    return Mesh(p, n, None, t)


def oranges(radius, count, seed):
    rs = np.random.RandomState(seed)
    parts = []
    for _ in range(count):
        d = rs.standard_normal(3)
        d[1] = -abs(d[1]) * 0.5 + 0.2
        d /= np.linalg.norm(d)
        parts.append(sphere(0.036, 10, 6).moved(translate(*(d * radius * 0.97))))
    return join(parts)


def pot(height=0.52, segments=28):
    """A rolled-rim terracotta pot, filled with earth to 6 cm below the rim; (pot, earth)."""
    k = height / 0.52
    p = [(0.0, 0), (0.19, 0), (0.195, 0.015), (0.235, 0.20), (0.265, 0.38), (0.27, 0.40), (0.285, 0.405), (0.285, 0.43),
         (0.275, 0.44), (0.285, 0.45), (0.31, 0.465), (0.315, 0.49), (0.305, 0.515), (0.285, 0.52), (0.262, 0.51),
         (0.255, 0.45)]
    soil = [(0.256, 0.455), (0.15, 0.47), (0.0, 0.475)]
    return (lathe([(r * k, y * k) for r, y in p], segments, smooth=50),
            lathe([(r * k, y * k) for r, y in soil], 20))


def trunk(y0, y1, radius=0.022):
    t = np.linspace(0, 1, 7)
    return lathe([(radius * (1.25 - 0.35 * v), y0 + (y1 - y0) * v) for v in t], 9)


def ripples(x0, x1, z0, z1, nx, nz, seed=2):
    """Still water: a level grid whose normals tilt by a few milliradians, as a draught leaves it."""
    rs = np.random.RandomState(seed)
    z, x = np.meshgrid(np.linspace(z0, z1, nz + 1), np.linspace(x0, x1, nx + 1), indexing="ij")
    dx, dz = 0 * x, 0 * x
    for _ in range(14):
        a, wave = rs.uniform(0, 2 * np.pi), rs.uniform(0.35, 1.6)
        kx, kz = 2 * np.pi / wave * np.cos(a), 2 * np.pi / wave * np.sin(a)
        slope = 0.0035 * np.cos(kx * x + kz * z + rs.uniform(0, 2 * np.pi))
        dx, dz = dx + slope * np.cos(a), dz + slope * np.sin(a)
    n = np.stack([-dx, 1 + 0 * x, -dz], 2)
    return grid(np.stack([x, 0 * x, z], 2), n.reshape(-1, 3))


def terrace(s, top, z0, z1, half, rail):
    """Paved terrace from z0 back to z1 at height `top` with the balustrade mesh `rail` along its far edge."""
    s.mesh("terrace", [(box((-half, -0.4, z1), (half, top, z0), "-y +z"), "floor")])
    s.place("terrace")
    n = int(half * 2 / 1.5)
    for i in range(n):
        s.place(rail, ((i + 0.5 - n / 2) * 1.5, top, z1 + 0.15))
    s.mesh("hills", [(hills(58, 90, 4, 3.4), "hills")])
    s.mesh("near hills", [(hills(46, 70, 11, 1.9), "woods")])
    for yaw in (0, 90, 180, 270):
        s.place("hills", yaw=yaw)
        s.place("near hills", yaw=yaw)
    s.mesh("cypress", [(cypress(8.5, 0.95, 1), "cypress")])
    for x, z, k, yaw in ((-2.9, -33.0, 0.92, 0), (-1.75, -39.0, 1.0, 120), (1.9, -35.0, 0.72, 40),
                         (3.4, -37.5, 1.05, 200), (-5.2, -36.0, 1.0, 70), (5.8, -41.0, 1.0, 300),
                         (-6.5, 24.0, 0.9, 20), (7.2, 27.0, 1.0, 150)):
        s.place("cypress", (x, -0.3, z), yaw, scale=k)
    s.mesh("ground", [(quad((-60, -0.05, 60), (60, -0.05, 60), (60, -0.05, -60), (-60, -0.05, -60)), "earth")])
    s.place("ground")


def orange_trees(s, places):
    """places: (x, z, yaw, scale)."""
    shell, soil = pot()
    s.mesh("orange tree", [(shell, "terracotta"), (soil, "soil"), (trunk(0.47, 1.25), "bark"),
                           (leaf_ball(0.46, 1250, 5).moved(translate(0, 1.52, 0)), "leaves"),
                           (oranges(0.46, 11, 8).moved(translate(0, 1.52, 0)), "orange")])
    for x, z, yaw, k in places:
        s.place("orange tree", (x, 0, z), yaw, scale=k)
