"""Architecture and furnishings of the atrium: each function returns a Mesh about its own origin, uv in metres."""
import numpy as np

from gltf import Mesh, join
from shapes import box, grid, lathe, planar_uv, quad, rotate, sphere, sweep, translate


# ---- columns -------------------------------------------------------------------------------------------------------
def torus_profile(r, y0, y1, bulge, steps=5):
    """Half-round moulding between two heights."""
    a = np.linspace(-90, 90, steps + 1)
    m, h = (y0 + y1) / 2, (y1 - y0) / 2
    return [(r + bulge * np.cos(np.radians(v)), m + h * np.sin(np.radians(v))) for v in a]


def shaft_profile(r0, r1, y0, y1, steps=6):
    """Entasis: widest a third up, then drawing in."""
    t = np.linspace(0, 1, steps + 1)
    r = r0 + (r1 - r0) * t ** 1.8 + 0.012 * np.sin(np.pi * t) * r0 / 0.27
    return list(zip(r, y0 + (y1 - y0) * t))


def column(height, r, segments=24):
    """Plinth, base, shaft and necking up to 0.55 r_scale below the abacus; `leaves` and `abacus` complete it."""
    s = r / 0.27
    base = [(0.36 * s, 0.14 * s)] + torus_profile(0.33 * s, 0.14 * s, 0.235 * s, 0.045 * s)
    base += [(0.325 * s, 0.245 * s), (0.30 * s, 0.265 * s), (0.298 * s, 0.28 * s)]
    base += torus_profile(0.29 * s, 0.285 * s, 0.335 * s, 0.028 * s, 4) + [(0.285 * s, 0.345 * s), (r, 0.40 * s)]
    neck = height - 0.62 * s
    shaft = shaft_profile(r, 0.85 * r, 0.40 * s, neck - 0.05 * s)
    top = [(0.87 * r, neck - 0.04 * s)] + torus_profile(0.86 * r, neck - 0.04 * s, neck + 0.01 * s, 0.03 * s, 4)
    top += [(0.86 * r, neck + 0.012 * s)]
    bell = [(0.85 * r, neck + 0.012 * s), (0.86 * r, neck + 0.25 * s), (0.95 * r, neck + 0.40 * s),
            (1.12 * r, neck + 0.47 * s)]
    plinth = 0.37 * s
    return join([box((-plinth, 0, -plinth), (plinth, 0.14 * s, plinth), "-y"),
                 lathe(base + shaft[1:] + top, segments), lathe(bell, segments)])


def leaves(r, neck, rows=2, count=8, around=48, along=7):
    """Rings of stylised acanthus that curl outwards, growing from the bell of a capital."""
    s = r / 0.27
    parts = []
    for k in range(rows):
        y0, y1 = neck + 0.01 * s, neck + (0.27 + 0.20 * k) * s
        phi = 2 * np.pi * np.arange(around + 1) / around
        t = np.linspace(0, 1, along + 1)[:, None]
        lobe = np.cos(count / 2 * phi + k * np.pi / 2) ** 2            # 1 on a leaf's axis, 0 between leaves
        width = np.clip(lobe, 0, 1)[None, :]
        reach = np.clip(1.15 * width ** 0.5, 0, 1)                     # the leaf is shorter towards its edge
        rib = 0.5 + 0.5 * np.cos(5 * count * phi)[None, :]
        curl = np.clip((t - 0.55) / 0.45, 0, 1)
        rad = 0.86 * r + 0.012 * s + (0.035 + 0.03 * k) * s * t ** 1.5 * width ** 0.4 \
            + 0.085 * s * np.sin(curl * np.pi / 2) ** 2 * reach + 0.006 * s * rib * t * width
        y = y0 + (y1 - y0) * (t * (0.55 + 0.45 * reach) - 0.16 * curl ** 2.2 * reach)
        c, sn = np.cos(phi)[None, :], np.sin(phi)[None, :]
        p = np.stack([rad * sn, y + 0 * sn, rad * c], 2)
        p[:, -1] = p[:, 0]
        uv = np.stack([np.repeat(phi[None, :] * r, along + 1, 0), -y], 2)
        m = grid(p, None, uv.reshape(-1, 2), close=True)
        parts.append(Mesh(m.p, -m.n, m.uv, m.t[:, ::-1]))
    return join(parts)


def abacus(half, y0, y1):
    mid = y0 + 0.45 * (y1 - y0)
    return join([box((-half * 0.9, y0, -half * 0.9), (half * 0.9, mid, half * 0.9)),
                 box((-half, mid, -half), (half, y1, half))])


# ---- walls ---------------------------------------------------------------------------------------------------------
def arch_points(radius, segments):
    a = np.pi * np.arange(segments + 1) / segments
    return np.stack([radius * np.cos(a), radius * np.sin(a)], 1)


def arch_panel(width, bottom, spring, top, radius, thick, segments=28, ends=False, faces="+-"):
    """A wall in the x-y plane, `thick` deep about z = 0, pierced by a round-headed opening from `bottom` up."""
    arc = arch_points(radius, segments)
    parts, h, w = [], thick / 2, width / 2

    def face(points):
        for side in faces:
            z = h if side == "+" else -h
            q = [(x, y, z) for x, y in points]
            parts.append(planar_uv(quad(*(q if side == "+" else q[::-1]))))

    face([(radius, bottom), (w, bottom), (w, top), (radius, top)])
    face([(-w, bottom), (-radius, bottom), (-radius, top), (-w, top)])
    for (xa, ya), (xb, yb) in zip(arc[:-1], arc[1:]):
        face([(xb, spring + yb), (xa, spring + ya), (xa, top), (xb, top)])
    # the opening's inner side: jambs and soffit
    path = np.concatenate([[[radius, bottom - spring]] if spring > bottom else np.empty((0, 2)), arc,
                           [[-radius, bottom - spring]] if spring > bottom else np.empty((0, 2))])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    arc_n = [(-1, 0)] * (spring > bottom) + [(-x / radius, -y / radius) for x, y in arc] + \
        [(1, 0)] * (spring > bottom)
    p = np.array([[(x, y + spring, z) for x, y in path] for z in (-h, h)])
    n = np.array([[(x, y, 0) for x, y in arc_n]] * 2)
    uv = np.array([[(z, -v) for v in along] for z in (-h, h)])
    m = grid(p, n, uv.reshape(-1, 2))
    f = m.t[0]
    inward = np.dot(np.cross(m.p[f[1]] - m.p[f[0]], m.p[f[2]] - m.p[f[0]]), m.n[f[0]]) > 0
    parts.append(m if inward else Mesh(m.p, m.n, m.uv, m.t[:, ::-1]))
    if ends:
        parts.append(box((-w, bottom, -h), (w, top, h), "+z -z +y -y"))
    return join(parts)


def archivolt(radius, width, proud, z, segments=24, side=1):
    """Moulded ring on the face of an arch springing at y = 0; `side` is the sign of the face's z."""
    arc = arch_points(1.0, segments)
    A = np.stack([arc[:, 0], arc[:, 1], 0 * arc[:, 0]], 1)
    B = np.tile([0.0, 0, side], (len(arc), 1))
    path = radius * A + [0, 0, z]
    w, e = width, proud
    profile = [(w, 0), (w, e), (0.80 * w, e), (0.76 * w, 0.55 * e), (0.40 * w, 0.55 * e), (0.36 * w, 0.8 * e),
               (0.10 * w, 0.8 * e), (0, 0.6 * e), (0, 0)]
    m = sweep(profile, path, (A, B), uv_along=np.pi * radius * np.arange(segments + 1) / segments)
    return m


def keystone(radius, width, proud, z, side=1):
    """Wedge at the crown of an arch, standing a little proud of the archivolt."""
    a, b = 0.085, 0.12
    y0, y1 = radius - 0.015, radius + width + 0.07
    z0, z1 = z, z + side * (proud + 0.035)
    f = [(-a, y0), (a, y0), (b, y1), (-b, y1)]
    if side < 0:
        f = [(-x, y) for x, y in f]
    front = [(x, y, z1) for x, y in f]
    back = [(x, y, z0) for x, y in f]
    sides = [quad(back[i], back[(i + 1) % 4], front[(i + 1) % 4], front[i]) for i in range(4)]
    return planar_uv(join([quad(*front)] + sides))


def cornice(length, steps, dentils=0.0):
    """A straight moulding along x, centred; steps: (out, up) profile from the wall's bottom to its top, out in +z."""
    pts = np.array([(-length / 2, 0, 0), (length / 2, 0, 0)])
    A, B = np.tile([0.0, 0, 1], (2, 1)), np.tile([0.0, 1, 0], (2, 1))
    parts = [sweep(steps, pts, (A, B))]
    if dentils:
        out = max(p[0] for p in steps) * 0.55
        y = steps[1][1]
        n = int(round(length / dentils))
        for i in range(n):
            x = -length / 2 + (i + 0.5) * length / n
            w = 0.28 * length / n
            parts.append(box((x - w, y + 0.005, 0), (x + w, y + 0.085, out), "-z +y"))
    return join(parts)


def round_hole_panel(half_w, half_h, radius, depth, segments=16):
    """A rectangle facing +z about the origin with a round hole and the hole's sleeve going back `depth`."""
    side = np.linspace(-1, 1, segments + 1)[:-1]
    edge = np.concatenate([np.stack([side, -np.ones(segments)], 1), np.stack([np.ones(segments), side], 1),
                           np.stack([-side, np.ones(segments)], 1), np.stack([-np.ones(segments), -side], 1)])
    edge = np.concatenate([edge, edge[:1]]) * (half_w, half_h)
    circle = edge / np.linalg.norm(edge, axis=1, keepdims=True) * radius
    z = np.zeros((len(edge), 1))
    face = grid(np.stack([np.hstack([edge, z]), np.hstack([circle, z])]))
    if face.n[0, 2] < 0:
        face = face.flipped()
    sleeve = grid(np.stack([np.hstack([circle, z]), np.hstack([circle, z - depth])]),
                  np.stack([np.hstack([-circle, z])] * 2))
    f = sleeve.t[0]
    if np.dot(np.cross(sleeve.p[f[1]] - sleeve.p[f[0]], sleeve.p[f[2]] - sleeve.p[f[0]]), sleeve.n[f[0]]) < 0:
        sleeve = Mesh(sleeve.p, sleeve.n, sleeve.uv, sleeve.t[:, ::-1])
    return planar_uv(join([face, sleeve]))


# ---- vault ---------------------------------------------------------------------------------------------------------
def on_vault(R, s, z, depth=0.0):
    """Points of a barrel vault of radius R about the z axis; s is arc length from the crown, depth goes outwards."""
    a = s / R
    return np.stack([(R + depth) * np.sin(a), (R + depth) * np.cos(a), z + 0 * a], -1)


def coffer(R, s0, s1, z0, z1, steps=3):
    """One coffer seen from below: a rib frame and two sunk steps around a panel."""
    loops = [(0.0, 0.0), (0.13, 0.0), (0.145, 0.10), (0.215, 0.10), (0.23, 0.19)]
    parts = []

    def loop(inset, depth):
        a = np.linspace(s0 + inset, s1 - inset, steps + 1)
        z = np.array([z0 + inset, z1 - inset])
        return [(on_vault(R, a, z[0], depth)), (on_vault(R, a, z[1], depth))]

    for (i0, d0), (i1, d1) in zip(loops[:-1], loops[1:]):
        o, n = loop(i0, d0), loop(i1, d1)
        for k in range(steps):
            parts.append(quad(o[0][k], o[0][k + 1], n[0][k + 1], n[0][k]))
            parts.append(quad(o[1][k + 1], o[1][k], n[1][k], n[1][k + 1]))
        parts.append(quad(o[1][0], o[0][0], n[0][0], n[1][0]))
        parts.append(quad(o[0][-1], o[1][-1], n[1][-1], n[0][-1]))
    last = loop(*loops[-1])
    for k in range(steps):
        parts.append(quad(last[0][k], last[0][k + 1], last[1][k + 1], last[1][k]))
    m = join(parts)
    face = np.cross(m.p[m.t[:, 1]] - m.p[m.t[:, 0]], m.p[m.t[:, 2]] - m.p[m.t[:, 0]])
    middle = np.array([*on_vault(R, np.array([(s0 + s1) / 2]), (z0 + z1) / 2, -1.0)[0]])
    t = m.t.copy()
    wrong = np.einsum("ij,ij->i", face, middle - m.p[m.t].mean(axis=1)) < 0
    t[wrong] = t[wrong][:, ::-1]
    n = m.n.copy()
    n[np.unique(m.t[wrong])] *= -1
    a = np.arctan2(m.p[:, 0], m.p[:, 1]) * R
    return Mesh(m.p, n, np.stack([a, m.p[:, 2]], 1), t)


def coffer_ring(R, arc, cells, skip=0):
    """A metre of vault, `arc` metres around: `cells` coffers, `skip` of them left out about the crown."""
    size = arc / cells
    keep = [k for k in range(cells) if not (cells - skip) / 2 <= k < (cells + skip) / 2]
    return join([coffer(R, -arc / 2 + k * size, -arc / 2 + (k + 1) * size, -0.5, 0.5) for k in keep])


def vault_rib(R, half_arc, width=0.46, drop=0.09, segments=40):
    """A transverse band on the underside of the vault, moulded along both edges."""
    a = np.linspace(-half_arc, half_arc, segments + 1)
    radial = np.stack([np.sin(a), np.cos(a), 0 * a], 1)
    w, d = width / 2, drop
    profile = [(-w, 0.02), (-w, -0.6 * d), (-w + 0.05, -0.6 * d), (-w + 0.06, -d), (w - 0.06, -d), (w - 0.05, -0.6 * d),
               (w, -0.6 * d), (w, 0.02)]
    m = sweep(profile, R * radial, (np.tile([0.0, 0, 1], (len(a), 1)), radial))
    face = np.cross(m.p[m.t[:, 1]] - m.p[m.t[:, 0]], m.p[m.t[:, 2]] - m.p[m.t[:, 0]]).sum(axis=0)
    return m if face[1] < 0 else m.flipped()


def oculus_patch(R, half_s, half_z, radius, top, per_side=12):
    """The piece of vault about an oculus, with a moulded collar and a shaft up to `top` above the vault's axis."""
    side = np.linspace(-1, 1, per_side + 1)[:-1]
    edge = np.concatenate([np.stack([side, -np.ones(per_side)], 1), np.stack([np.ones(per_side), side], 1),
                           np.stack([-side, np.ones(per_side)], 1), np.stack([-np.ones(per_side), -side], 1)])
    edge = np.concatenate([edge, edge[:1]])
    rows = [on_vault(R, edge[:, 0] * half_s, edge[:, 1] * half_z)]
    flat = np.stack([R * np.sin(edge[:, 0] * half_s / R), edge[:, 1] * half_z], 1)
    unit = flat / np.linalg.norm(flat, axis=1, keepdims=True)

    def circle(r, depth):
        x, z = unit[:, 0] * r, unit[:, 1] * r
        return np.stack([x, np.sqrt(R * R - x * x) + depth, z], 1)

    for r, d in ((radius + 0.22, 0.0), (radius + 0.21, -0.07), (radius + 0.16, -0.07), (radius + 0.14, -0.02),
                 (radius + 0.08, -0.02), (radius + 0.06, -0.10), (radius, -0.10)):
        rows.append(circle(r, d))
    shaft_top = circle(radius, 0)
    shaft_top[:, 1] = top
    rows.append(shaft_top)
    parts = []
    for a, b in zip(rows[:-1], rows[1:]):
        for k in range(len(edge) - 1):
            parts.append(quad(a[k], a[k + 1], b[k + 1], b[k]))
    m = join(parts)
    face = np.cross(m.p[m.t[:, 1]] - m.p[m.t[:, 0]], m.p[m.t[:, 2]] - m.p[m.t[:, 0]])
    wrong = np.einsum("ij,ij->i", face, np.array([0, R - 1.2, 0]) - m.p[m.t].mean(axis=1)) < 0
    t, n = m.t.copy(), m.n.copy()
    t[wrong] = t[wrong][:, ::-1]
    n[np.unique(m.t[wrong])] *= -1
    return Mesh(m.p, n, np.stack([np.arctan2(m.p[:, 0], m.p[:, 1]) * R, m.p[:, 2]], 1), t)


# ---- furnishings ---------------------------------------------------------------------------------------------------
def baluster(segments=7):
    p = [(0.062, 0), (0.062, 0.045), (0.038, 0.07), (0.069, 0.20), (0.045, 0.36), (0.031, 0.49), (0.046, 0.525),
         (0.033, 0.555), (0.062, 0.62), (0.062, 0.67)]
    return lathe(p, segments)


def balustrade(length, count):
    """Between two columns, along x: plinth course, balusters, moulded rail; 1.0 m high."""
    b = baluster()
    parts = [b.moved(translate((i + 0.5 - count / 2) * length / count, 0.14, 0)) for i in range(count)]
    parts.append(box((-length / 2, 0, -0.11), (length / 2, 0.14, 0.11), "-y"))
    parts.append(box((-length / 2, 0.81, -0.085), (length / 2, 0.87, 0.085)))
    parts.append(box((-length / 2, 0.87, -0.125), (length / 2, 0.97, 0.125)))
    parts.append(box((-length / 2, 0.97, -0.105), (length / 2, 1.0, 0.105), "-y"))
    return join(parts)


def hanging(width, length, seed, folds=5.0, depth=0.05, nu=40, nv=60):
    """Cloth hung from its upper edge at y = 0: folds die out towards the rod, the hem swings a little. uv 0 to 1."""
    rs = np.random.RandomState(seed)
    u, v = np.meshgrid(np.linspace(0, 1, nu + 1), np.linspace(0, 1, nv + 1))
    phase = rs.uniform(0, 2 * np.pi, 5)
    wave = np.sin(2 * np.pi * folds * u + phase[0] + 0.9 * np.sin(2.2 * v + phase[1]))
    wave += 0.5 * np.sin(2 * np.pi * folds * 0.43 * u + phase[2] - 1.3 * v) + \
        0.22 * np.sin(2 * np.pi * folds * 1.9 * u + phase[3] + 1.7 * v)
    z = depth * wave * (0.35 + 0.65 * np.minimum(v * 1.6, 1)) + 0.05 * v ** 2 * np.sin(phase[4] + 2.5 * u)
    x = (u - 0.5) * width * (1 - 0.05 * v) + 0.012 * np.sin(6 * v + phase[1])
    y = -v * length + 0.03 * np.sin(np.pi * u) * -v
    return grid(np.stack([x, y, z], 2)[::-1], None, np.stack([u, v], 2)[::-1].reshape(-1, 2)).flipped()


def rail_cloth(width, drop, seed, rail=0.13, back=0.35, nu=40, nv=48):
    """A rug thrown over a rail along x (its top at y = 0): `drop` down the front, over, and `back` down the back."""
    rs = np.random.RandomState(seed)
    phase = rs.uniform(0, 2 * np.pi, 4)
    total = drop + 2 * rail + back
    s = np.linspace(0, total, nv + 1)
    y = np.where(s < drop, -(drop - s), np.where(s < drop + 2 * rail, 0.012, -(s - drop - 2 * rail)))
    z = np.where(s < drop, rail + 0.015, np.where(s < drop + 2 * rail, rail + 0.015 - (s - drop), -rail - 0.015))
    u, v = np.meshgrid(np.linspace(0, 1, nu + 1), s / total)
    hang = np.clip(-y, 0, None)[:, None] / max(drop, 1e-6)
    ripple = np.sin(2 * np.pi * 3.2 * u + phase[0] + hang) + 0.5 * np.sin(2 * np.pi * 5.3 * u + phase[1])
    sign = np.where(z > 0, 1, -1)[:, None]
    zz = z[:, None] + sign * 0.022 * np.clip(hang * 1.5, 0, 1) * (1.2 + ripple)
    x = (u - 0.5) * width * (1 - 0.04 * hang)
    return grid(np.stack([x, y[:, None] + 0 * u, zz], 2), None,
                np.stack([u, 1 - v], 2).reshape(-1, 2)).flipped()


def urn(height=0.9, segments=40):
    p = [(0.0, 0), (0.15, 0), (0.16, 0.02), (0.15, 0.045), (0.11, 0.07), (0.10, 0.09), (0.13, 0.13), (0.21, 0.23),
         (0.275, 0.36), (0.29, 0.47), (0.27, 0.58), (0.21, 0.68), (0.14, 0.75), (0.105, 0.79), (0.105, 0.83),
         (0.14, 0.87), (0.165, 0.885), (0.17, 0.90), (0.15, 0.90), (0.115, 0.86), (0.085, 0.82), (0.085, 0.76),
         (0.16, 0.66), (0.0, 0.55)]
    k = height / 0.9
    return lathe([(r * k, y * k) for r, y in p], segments, smooth=50)


def pedestal(height, radius=0.33):
    """A short round pillar with base and cap, standing on a square plinth."""
    r, h = radius, height
    p = [(r * 0.98, 0.10)] + torus_profile(r * 0.92, 0.10, 0.17, 0.035) + [(r * 0.88, 0.18), (r * 0.80, 0.21)]
    p += [(r * 0.78, 0.24), (r * 0.76, h - 0.16)] + torus_profile(r * 0.76, h - 0.15, h - 0.12, 0.02, 4)
    p += [(r * 0.80, h - 0.10), (r * 0.95, h - 0.06), (r, h - 0.055), (r, h - 0.008), (r - 0.008, h), (0.0, h)]
    return join([box((-r * 1.05, 0, -r * 1.05), (r * 1.05, 0.10, r * 1.05), "-y"), lathe(p, 56)])


def bowl(radius=0.30, segments=60):
    """Open bowl on a foot, walls 6 mm: the caustic of its inside falls on its own floor and beside it."""
    a = np.radians(np.linspace(8, 86, 22))
    outer = [(radius * np.sin(v), radius * 0.92 * (1 - np.cos(v)) + 0.03) for v in a]
    inner = [((radius - 0.006) * np.sin(v), radius * 0.92 * (1 - np.cos(v)) + 0.037) for v in a[::-1]]
    foot = [(0.0, 0.004), (0.10, 0.0), (0.105, 0.006), (0.085, 0.02), (0.05, 0.032)]
    lip = [(outer[-1][0] + 0.012, outer[-1][1] + 0.004), (outer[-1][0] + 0.012, outer[-1][1] + 0.010)]
    return lathe(foot + outer + lip + inner + [(0.0, 0.037)], segments, smooth=50)


def lantern_parts(radius, hang):
    """(brass, glass, flame) of a lamp hanging `hang` below its hook, about the globe's centre; the globe is a shell of
    solid glass, closed above and below by brass."""
    a = np.radians(np.linspace(180 - 24, 24, 22))
    outside = [(radius * np.sin(v), radius * np.cos(v)) for v in a]
    inside = [((radius - 0.008) * np.sin(v), (radius - 0.008) * np.cos(v)) for v in a[::-1]]
    glass = lathe(outside + inside + [outside[0]], 40, smooth=40)
    top, r = outside[-1][1], outside[-1][0]
    brass = join([
        lathe([(0.0, -top - 0.065), (0.018, -top - 0.06), (0.02, -top - 0.045), (r + 0.012, -top - 0.014),
               (r + 0.014, -top + 0.006), (r - 0.012, -top + 0.004), (0, -top - 0.004)], 32),
        lathe([(0.0, top - 0.004), (r - 0.012, top - 0.004), (r + 0.014, top - 0.006), (r + 0.012, top + 0.012),
               (r * 0.6, top + 0.035), (0.016, top + 0.06), (0.014, top + 0.075), (0.006, top + 0.08),
               (0.006, hang)], 32)])
    flame = sphere(radius * 0.5, 16, 8)
    return brass, glass, flame


def globe_lamp(radius=0.11):
    """(brass, globe) of an opal globe on a short chain: the globe itself is emissive."""
    globe = sphere(radius, 16, 10)
    brass = lathe([(0.0, radius * 0.9), (radius * 0.45, radius * 0.91), (radius * 0.47, radius * 1.02),
                   (radius * 0.2, radius * 1.2), (0.012, radius * 1.3), (0.005, radius * 1.35), (0.005, 0.85)], 20)
    return brass, globe


def bench(length=1.7):
    top = box((-length / 2, 0.42, -0.19), (length / 2, 0.47, 0.19))
    legs = [box((s * (length / 2 - 0.22) - 0.035, 0, -0.16), (s * (length / 2 - 0.22) + 0.035, 0.42, 0.16), "-y +y")
            for s in (-1, 1)]
    bar = box((-length / 2 + 0.25, 0.16, -0.025), (length / 2 - 0.25, 0.24, 0.025), "+x -x")
    m = join([top, bar] + legs)
    long_u = np.stack([m.uv[:, 1], m.uv[:, 0]], 1)
    return m.with_uv(long_u)


def rod(length, radius=0.018):
    """A rod along x."""
    return lathe([(radius, -length / 2), (radius, length / 2)], 10).moved(rotate("z", 90))
