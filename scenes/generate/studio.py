"""A stove-top espresso maker and a cup on a bright sweep (`studio`): mostly easy pixels, a few that are hard.

Evenly lit paper fills the frame under a soft box and converges in a few samples, because the box is seen under about the
same angle from all of it; soft shadows and blurred reflections in satin aluminium and glaze, on a quarter of the picture,
take ten times more. No light here is small and strong, and none shines through glass: a narrow strip beside the pot threw
so rare caustics through the glaze that a few tiles took all the time.
"""
import numpy as np

import textures
from gltf import Mesh, Scene, join
from shapes import box, grid, rotate, translate

SPOUT, HANDLE = -1, 1          # the pot's spout points to -x, its handle to +x
RIM = 0.168                    # height of the pot's rim under the lid


# ---- turned and faceted bodies -------------------------------------------------------------------------------------
def fillets(corners, step=9.0):
    """Points and directions along (a, b[, radius]) corners joined by straight lines, each corner rounded by an arc.

    A corner without radius stays sharp: its point appears twice, with the directions before and after it.
    """
    c = np.array([k[:2] for k in corners], float)
    radius = [k[2] if len(k) > 2 else 0.0 for k in corners]
    d = np.diff(c, axis=0)
    length = np.linalg.norm(d, axis=1)
    d /= length[:, None]
    points, directions = [c[0]], [d[0]]
    for k in range(1, len(c) - 1):
        a, b = d[k - 1], d[k]
        turn = np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b)
        back = min(radius[k] * np.tan(abs(turn) / 2), 0.49 * length[k - 1], 0.49 * length[k])
        n = max(2, int(np.ceil(np.degrees(abs(turn)) / step))) if back > 1e-6 else 1
        r = back / np.tan(abs(turn) / 2) if back > 1e-6 else 0.0
        for t in np.linspace(0, turn, n + 1):
            s, co = np.sin(t), np.cos(t)
            at = c[k] - a * back
            if r:
                side = np.sign(turn) * np.array([-a[1], a[0]])
                at = at + r * (a * abs(s) + side * (1 - co))
            points.append(at)
            directions.append(np.array([a[0] * co - a[1] * s, a[0] * s + a[1] * co]))
    points.append(c[-1]), directions.append(d[-1])
    return np.array(points), np.array(directions)


def ring(segments=96):
    """Outline of a turned body: points (x, z) at distance 1 and their normals, closed."""
    a = 2 * np.pi * np.arange(segments + 1) / segments
    q = np.stack([np.sin(a), np.cos(a)], 1)
    q[-1] = q[0]
    return q, q


def polygon(sides, edge, steps=5):
    """Outline of a faceted body: a polygon whose flats are at distance 1, its corners rounded by the radius `edge`;
    a flat faces +z, and with it -x and +x where 4 divides the number of sides."""
    half = np.pi / sides
    q, n = [], []
    for k in range(sides):
        mid = 2 * half * k + half
        centre = (1 - edge) / np.cos(half) * np.array([np.sin(mid), np.cos(mid)])
        for a in np.linspace(mid - half, mid + half, steps + 1):
            normal = np.array([np.sin(a), np.cos(a)])
            q.append(centre + edge * normal), n.append(normal)
    return np.array(q + q[:1]), np.array(n + n[:1])


def body(corners, outline, step=9.0):
    """Scales an outline along a profile of (distance, height[, radius]) corners, outside to the right going up; normals
    are exact. uv in metres: around and down."""
    p, t = fillets(corners, step)
    q, n = outline
    reach = np.einsum("ij,ij->i", q, n)
    around = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(q, axis=0), axis=1))]) * p[:, 0].max()
    down = -np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    points = np.stack([p[:, :1] * q[:, 0], np.repeat(p[:, 1:], len(q), 1), p[:, :1] * q[:, 1]], 2)
    normals = np.stack([t[:, 1:] * n[:, 0], -t[:, :1] * reach[None, :], t[:, 1:] * n[:, 1]], 2)
    uv = np.stack([np.repeat(around[None, :], len(p), 0), np.repeat(down[:, None], len(q), 1)], 2)
    m = grid(points, normals, uv.reshape(-1, 2))
    return Mesh(m.p, m.n, m.uv, m.t[:, ::-1])


def tube(corners, width, thick, power=2.0, step=0.002, segments=32, start=0.0, end=0.0):
    """A bar along (x, y[, radius]) corners in the plane z = 0: `width` across it and `thick` in it, each a number or
    (first, last); outline a superellipse. start, end: length over which that end is rounded off; 0 leaves it open."""
    p, t = fillets(corners, 6.0)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    keep = np.concatenate([[True], np.diff(along) > 1e-7])
    p, t, along = p[keep], t[keep], along[keep]
    total = along[-1]
    round_off = 1 - np.cos(np.radians(np.linspace(0, 90, 9)))
    s = np.unique(np.concatenate([np.linspace(0, total, int(total / step) + 2), start * round_off,
                                  total - end * round_off]).round(7))
    s = s[(s >= 0) & (s <= total)]
    x, y, tx, ty = (np.interp(s, along, v) for v in (p[:, 0], p[:, 1], t[:, 0], t[:, 1]))
    fade = np.ones_like(s)
    if start:
        fade *= np.sqrt(np.clip(1 - np.clip(1 - s / start, 0, 1) ** 2, 0, 1))
    if end:
        fade *= np.sqrt(np.clip(1 - np.clip(1 - (total - s) / end, 0, 1) ** 2, 0, 1))
    ramp = s / total
    half_w = fade * np.interp(ramp, [0, 1], np.broadcast_to(width, 2)) / 2
    half_t = fade * np.interp(ramp, [0, 1], np.broadcast_to(thick, 2)) / 2
    a = 2 * np.pi * np.arange(segments + 1) / segments
    c, si = np.cos(a), np.sin(a)
    c[-1], si[-1] = c[0], si[0]
    u, v = np.sign(c) * np.abs(c) ** (2 / power), np.sign(si) * np.abs(si) ** (2 / power)
    size = np.hypot(tx, ty)
    tx, ty = tx / size, ty / size
    points = np.stack([x[:, None] - ty[:, None] * half_t[:, None] * u, y[:, None] + tx[:, None] * half_t[:, None] * u,
                       half_w[:, None] * v], 2)
    points[:, -1] = points[:, 0]
    uv = np.stack([np.repeat((a / (2 * np.pi) * 0.05)[None, :], len(s), 0), np.repeat(s[:, None], len(a), 1)], 2)
    m = grid(points, None, uv.reshape(-1, 2), close=True)
    ahead = np.array([tx[0], ty[0], 0])
    f = m.t[len(m.t) // 4]
    face = np.cross(m.p[f[1]] - m.p[f[0]], m.p[f[2]] - m.p[f[0]])
    middle = np.array([np.interp(m.uv[f[0], 1], s, x), np.interp(m.uv[f[0], 1], s, y), 0])
    out = m.p[f].mean(axis=0) - middle
    return m if np.dot(face, out - ahead * (out @ ahead)) > 0 else m.flipped()


# ---- the espresso maker --------------------------------------------------------------------------------------------
def beak(steps=26, across=32):
    """The spout: a V that leaves the flare and reaches its tip at the rim, thin-walled and open at the top."""
    def row(y, reach, half, inset):
        a = np.linspace(-1, 1, across + 1)
        soft = np.sqrt(a * a + 0.012) / np.sqrt(1.012)          # the V's keel, a little rounded
        wall = np.interp(y, [0.1180, 0.1295, RIM], [0.0352, 0.0372, 0.0475]) - 0.0025
        out = wall + (reach + 0.0025) * (1 - soft) * 1.12 - inset
        return np.stack([SPOUT * out, np.full_like(a, y), a * (half - 0.7 * inset)], 1)

    y0 = 0.116
    rows = []
    t = np.linspace(0, 1, steps + 1)
    for k in t:
        rows.append(row(y0 + (RIM - 0.0005 - y0) * k, 0.0235 * k ** 1.7, 0.004 + 0.0145 * k ** 0.8, 0.0))
    for inset, drop in ((0.0002, 0.0), (0.0007, -0.0002), (0.0012, 0.0003), (0.0013, 0.0012), (0.0014, 0.012)):
        k = 1 - drop / (RIM - y0)
        rows.append(row(RIM - drop, 0.0235 * k ** 1.7, 0.004 + 0.0145 * k ** 0.8, inset))
    m = grid(np.stack(rows))
    out = m.n[(steps // 2) * (across + 1) + across // 2][0] * SPOUT
    return m if out > 0 else m.flipped()


def espresso_maker(scene):
    octagon, turned = polygon(8, 0.075, 4), ring(72)
    boiler = body([(0, 0.0012), (0.044, 0.0012), (0.0455, 0.0), (0.0505, 0.0, 0.0028), (0.0438, 0.0735, 0.005),
                   (0.0362, 0.0805, 0.002), (0.032, 0.0805)], octagon)
    upper = body([(0.030, 0.0935), (0.0352, 0.0935, 0.0016), (0.0345, 0.116, 0.10), (0.0475, RIM, 0.0006),
                  (0.0458, RIM, 0.0006), (0.0450, 0.160)], octagon, 6.0)
    lid = body([(0.040, RIM + 0.0007), (0.0484, RIM + 0.0007, 0.0007), (0.0484, RIM + 0.0040, 0.0016),
                (0.0300, RIM + 0.0088, 0.06), (0.0105, RIM + 0.0165, 0.004), (0.0, RIM + 0.0168)], octagon, 6.0)
    hinge = body([(0, -0.011), (0.0032, -0.011, 0.0007), (0.0032, 0.011, 0.0007), (0, 0.011)], ring(24)).moved(
        translate(HANDLE * 0.0497, RIM + 0.0005, 0) @ rotate("x", 90))
    clasp = tube([(0.0385, 0.1545), (0.0605, 0.1562)], 0.0125, 0.0115, 5.0, end=0.0012)
    scene.mesh("espresso maker", [(join([boiler, upper, beak(), lid, hinge, clasp]), "satin aluminium")])
    collar = body([(0.032, 0.0795), (0.0385, 0.0795, 0.0012), (0.0385, 0.0835, 0.0012), (0.0362, 0.0842, 0.0008),
                   (0.0362, 0.0858, 0.0008), (0.0402, 0.0865, 0.0018), (0.0402, 0.0925, 0.0018),
                   (0.0352, 0.0935, 0.001), (0.030, 0.0940)], turned, 15.0)
    stem = body([(0.0098, RIM + 0.0155), (0.0098, RIM + 0.0190, 0.0008), (0.0062, RIM + 0.0200, 0.001),
                 (0.0062, RIM + 0.0225)], ring(64))
    scene.mesh("collar", [(join([collar, stem]), "polished steel")])
    knob = body([(0.0060, RIM + 0.0212), (0.0080, RIM + 0.0212, 0.0008), (0.0088, RIM + 0.0260, 0.012),
                 (0.0138, RIM + 0.0380, 0.006), (0.0120, RIM + 0.0468, 0.0055), (0.0, RIM + 0.0482)], ring(64), 6.0)
    handle = tube([(0.0570, 0.1560), (0.0885, 0.1600, 0.017), (0.0985, 0.0640)], (0.0150, 0.0185), (0.0135, 0.0115),
                  3.2, step=0.003, start=0.0020, end=0.0055)
    scene.mesh("grip", [(join([knob, handle]), "walnut")])
    hexagon = polygon(6, 0.08, 3)
    valve = join([body([(0.0070, -0.004), (0.0070, 0.0012, 0.0006), (0.0050, 0.0016)], ring(24)),
                  body([(0.0040, 0.0012), (0.0055, 0.0012, 0.0004), (0.0055, 0.0052, 0.0006), (0.0035, 0.0056)],
                       hexagon),
                  body([(0.0034, 0.0050), (0.0034, 0.0076, 0.0010), (0.0, 0.0078)], ring(24))])
    lean = np.degrees(np.arctan2(0.0505 - 0.0438, 0.0735))
    y = 0.050
    valve = valve.moved(rotate("y", -45) @ translate(0, y, 0.0505 - (0.0505 - 0.0438) * y / 0.0735) @
                        rotate("x", 90 - lean))
    scene.mesh("valve", [(valve, "brass")])
    return ["espresso maker", "collar", "grip", "valve"]


# ---- the cup -------------------------------------------------------------------------------------------------------
def cup(scene):
    turned = ring(72)
    lip = 0.0525
    outside = body([(0, 0.0022), (0.0165, 0.0022), (0.0175, 0.0, 0.0005), (0.0205, 0.0, 0.0006),
                    (0.0212, 0.0040, 0.0020), (0.0315, 0.0115, 0.016), (0.0345, lip, 0.0013), (0.0332, lip)], turned)
    inside = body([(0.0332, lip), (0.0318, lip, 0.0012), (0.0292, 0.0135, 0.014), (0.0, 0.0090)], turned)
    ear = tube([(0.0312, 0.0430), (0.0535, 0.0440, 0.0095), (0.0505, 0.0195, 0.0105), (0.0290, 0.0165)], 0.0068,
               0.0046, 2.4, step=0.0012, segments=24)
    coffee = body([(0.0318, 0.0432), (0.0300, 0.0424, 0.004), (0.0, 0.0424)], turned)
    saucer = body([(0, 0.0035), (0.0225, 0.0035), (0.0235, 0.0, 0.0006), (0.0300, 0.0, 0.0006), (0.0320, 0.0040, 0.004),
                   (0.0650, 0.0125, 0.02), (0.0668, 0.0150, 0.0009), (0.0655, 0.0158, 0.0009), (0.0350, 0.0078, 0.03),
                   (0.0245, 0.0068, 0.002), (0.0235, 0.0060, 0.001), (0.0, 0.0060)], ring(74), 12.0)
    scene.mesh("cup", [(join([outside, ear]), "glaze"), (inside, "porcelain"), (coffee, "crema")])
    scene.mesh("saucer", [(saucer, "glaze")])


def bean():
    """A roasted coffee bean lying on its back: flat, creased side up; 11 mm long."""
    rings, around = 20, 28
    th, ph = np.pi * np.arange(rings + 1) / rings, 2 * np.pi * np.arange(around + 1) / around
    x = np.repeat(np.cos(th)[:, None], around + 1, 1)
    y, z = np.sin(th)[:, None] * np.sin(ph), np.sin(th)[:, None] * np.cos(ph)
    y = np.where(y > 0, 0.35 * y, y)
    crease = np.exp(-((z - 0.08 * np.sin(3 * x)) / 0.10) ** 2) * (y > 0) * (1 - x ** 4)
    p = np.stack([0.0056 * x, 0.0034 * (y - 0.42 * crease * np.clip(6 * y, 0, 1)), 0.0040 * z * (1 - 0.12 * x * x)], 2)
    p[:, -1] = p[:, 0]
    m = grid(p, None, None, close=True)
    m = m if m.n[(rings // 2) * (around + 1)] @ m.p[(rings // 2) * (around + 1)] > 0 else m.flipped()
    return m.moved(translate(0, 0.0034, 0))


# ---- the studio ----------------------------------------------------------------------------------------------------
def paper(half=0.95, front=1.5, back=-0.75, radius=0.85, top=2.3):
    """The seamless sweep: floor, a quarter round, wall."""
    a = np.radians(np.linspace(0, 90, 65))
    z = np.concatenate([[front], back - radius * np.sin(a), [back - radius]])
    y = np.concatenate([[0], radius - radius * np.cos(a), [top]])
    ny, nz = np.concatenate([[1], np.cos(a), [0]]), np.concatenate([[0], np.sin(a), [1]])
    x = np.array([-half, half])
    points = np.stack(np.broadcast_arrays(x[None, :], y[:, None], z[:, None]), 2)
    normals = np.stack(np.broadcast_arrays(0 * x[None, :], ny[:, None], nz[:, None]), 2)
    m = grid(points, normals)
    f = m.t[0]
    up = np.cross(m.p[f[1]] - m.p[f[0]], m.p[f[2]] - m.p[f[0]])[1] > 0
    return m if up else Mesh(m.p, m.n, m.uv, m.t[:, ::-1])


def lamp(width, height, depth):
    """(emissive face, housing) of a soft box about the origin that emits along -z."""
    w, h = width / 2, height / 2
    face = grid(np.array([[(-w, -h, 0), (-w, h, 0)], [(w, -h, 0), (w, h, 0)]]))
    face = face if face.n[0, 2] < 0 else face.flipped()
    return face, box((-w - 0.01, -h - 0.01, 0.0002), (w + 0.01, h + 0.01, depth))


def walnut(n=512):
    """Oiled walnut, 10 cm, grain along v."""
    rings = textures.noise((n, n), 301, 1.1, 3, 90, (16.0, 1.0))
    figure = textures.noise((n, n), 302, 1.6, 1, 20, (5.0, 1.0))
    pores = textures.smooth(textures.noise((n, n), 303, 0.3, 40, 200, (9.0, 1.0)), 1.2, 2.6)
    t = np.clip(0.5 + 0.17 * rings + 0.16 * figure, 0, 1)
    color = textures.mix(textures.rgb(0.235, 0.118, 0.058), textures.rgb(0.075, 0.035, 0.018), t)
    color = color * (1 - 0.5 * pores)[..., None]
    return textures.Surface(color, np.zeros((n, n)), (0.1, 0.1))


def materials(s):
    s.material("paper", (0.47, 0.445, 0.413), lambert=True)
    s.material("satin aluminium", (0.79, 0.797, 0.81), rough=0.22, metal=1.0)
    s.material("polished steel", (0.68, 0.67, 0.65), rough=0.10, metal=1.0)
    s.material("brass", (0.90, 0.68, 0.34), rough=0.14, metal=1.0)
    s.material("walnut", (1, 1, 1), rough=0.34, maps=walnut().save(s.folder, "walnut", normal=False), metres=0.1)
    s.material("glaze", (0.018, 0.095, 0.105), rough=0.16)
    s.material("porcelain", (0.80, 0.775, 0.73), rough=0.18)
    s.material("crema", (0.36, 0.165, 0.055), rough=0.30)
    s.material("roast", (0.075, 0.034, 0.018), rough=0.32)
    s.material("black", (0.02, 0.02, 0.02), lambert=True)
    s.material("soft light", (0, 0, 0), lambert=True, emit=(1.0, 0.975, 0.94), strength=12.8)
    s.material("side light", (0, 0, 0), lambert=True, emit=(1.0, 0.94, 0.86), strength=3.2)


def main():
    s = Scene("studio")
    materials(s)
    s.mesh("sweep", [(paper(), "paper")])
    s.place("sweep")
    for name, size, at, aim in (("soft light", (1.2, 0.96, 0.12), (0.0, 1.55, -0.05), (0.0, 0.0, -0.30)),
                                ("side light", (0.50, 0.80, 0.06), (-0.95, 0.72, 0.05), (0.0, 0.08, 0.0))):
        face, housing = lamp(*size)
        s.mesh(name, [(face, name), (housing, "black")])
        s.place(name, matrix=Scene.look(at, aim, (0, 0, 1) if name == "soft light" else (0, 1, 0)))
    pot = (0.038, 0.0, -0.02)
    for name in espresso_maker(s):
        s.place(name, pot, 24.0)
    cup(s)
    s.place("saucer", (-0.092, 0, 0.040))
    s.place("cup", (-0.092, 0.0060, 0.040), 200.0)
    s.mesh("bean", [(bean(), "roast")])
    # at, yaw, roll (0: flat side up, 180: down)
    beans = ((-0.012, 0.100, 20, 0, 0), (0.001, 0.088, 110, 180, 1), (-0.026, 0.094, 65, 180, 2),
             (0.118, 0.072, -35, 0, 3), (0.021, 0.104, 40, 180, 4))
    for x, z, yaw, roll, k in beans:
        m = translate(x, 0, z) @ rotate("y", yaw) @ translate(0, 0.0034 if not roll else 0.0013, 0) @ \
            rotate("x", roll) @ translate(0, -0.0034, 0)
        s.place("bean", matrix=m, name=f"bean {k + 1}")
    eye, target = np.array([0.10, 0.42, 1.36]), np.array([0.004, 0.090, 0.0])
    s.camera("main", eye, target, yfov=13.4)
    s.write("A satin espresso maker and a glazed cup on a bright seamless sweep under a soft box and a "
            "weaker side light: mostly easy pixels, a few with soft shadow and blurred reflections. The test of adaptive "
            "sampling: most of the picture converges many times sooner than the last tenth.",
            {"film.ev": 0.0})


if __name__ == "__main__":
    main()
