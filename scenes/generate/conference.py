"""A meeting hall in the evening (`conference`): twenty spots in a coffered ceiling, carafes and glasses on a long table.

x to the right, y up; the table runs along z, a picture hangs on the wall at z = -7, windows are to the right, an acoustic
wall of oak slats to the left. Every coffer has a light ceiling of fabric, brighter over the table, and one spot: eight are
turned to the table's axis, two to the picture, seven to the walls, three to the carafes. Spots are points, so what they send
through solid glass and water onto the table is found by no path from the eye. Radiance is in cd/m^2 throughout, spots in
candela.
"""
import os

import numpy as np

import furniture as f
import glassware
import rooms
import textures
from gltf import Mesh, Scene, hdr, join
from shapes import box, chamfer, deformed, disk, facing, grid, lathe, planar_uv, quad, rotate, superquadric, translate

WIDTH, DEPTH, HEIGHT = 8.0, 14.0, 3.4
COLUMNS, ROWS = (-3.0, -1.0, 1.0, 3.0), (-5.6, -2.8, 0.0, 2.8, 5.6)
COFFER = (0.80, 1.20)                      # half width and half length
COFFER_TOP, MOUTH = 3.585, 3.46            # its ceiling; the lower edge of its lamp
TABLE = (0.86, 3.30)                       # half width and half length
TOP = 0.74                                 # the table's height
SILL, HEAD, WINDOW = 0.84, 2.86, 1.10      # windows' lower and upper edge, half length
WARM = (1.0, 0.89, 0.76)                   # the lamps' colour
SOFT, FILL = (1.0, 0.93, 0.84), {"middle": 58, "outer": 20}   # colour and luminance of the coffers' light ceilings
GROUPS = (-1.66, 0.62, 2.28)               # z of the carafes; camera `table` looks at those in the middle


# ---- what is painted -----------------------------------------------------------------------------------------------
def veneer(light, dark, seed, metres, pores=0.4, n=1024):
    """Wood with its grain along v."""
    rings = textures.noise((n, n), seed, 1.1, 3, 150, (16.0, 1.0))
    figure = textures.noise((n, n), seed + 1, 1.6, 1, 14, (4.0, 1.0))
    fine = textures.noise((n, n), seed + 2, 0.5, 60, 420, (14.0, 1.0))
    pore = textures.smooth(textures.noise((n, n), seed + 3, 0.3, 60, 320, (10.0, 1.0)), 1.5, 2.8)
    t = np.clip(0.5 + 0.17 * rings + 0.15 * figure + 0.05 * fine, 0, 1)
    color = textures.mix(textures.rgb(*light), textures.rgb(*dark), t)
    return textures.Surface(color * (1 - pores * pore)[..., None], np.zeros((n, n)), metres)


def carpet(n=1024):
    """Ribbed carpet tiles of 50 cm, every other one turned by a quarter; 2 m."""
    count, size = 4, n // 4
    y, x = np.mgrid[0:n, 0:n]
    i, j = y // size, x // size
    turned = (i + j) % 2 == 1
    rs = np.random.RandomState(3)
    tone = rs.uniform(-1, 1, (count, count))[i, j]
    along, across = textures.noise((n, n), 201, 0.6, 8, 200, (9.0, 1.0)), textures.noise((n, n), 202, 0.6, 8, 200, (1.0, 9.0))
    rib = np.cos(2 * np.pi * np.where(turned, y, x) / 8.0)
    shade = 1 + 0.075 * tone + 0.10 * rib + 0.05 * np.where(turned, across, along)
    return textures.Surface(textures.rgb(0.235, 0.226, 0.220) * shade[..., None], np.zeros((n, n)), (2.0, 2.0))


def painting(n=1024):
    """An abstract shore: layers from a pale sky over ochre to deep blue, drawn with a dry brush."""
    y, x = np.mgrid[0:n, 0:n] / n
    brush = textures.noise((n, n), 301, 0.8, 3, 220, (1.0, 10.0))
    color = np.ones((n, n, 3)) * textures.rgb(0.66, 0.60, 0.50)
    color = textures.mix(color, textures.rgb(0.60, 0.37, 0.19) * np.ones((n, n, 3)), textures.smooth(y, 0.10, 0.52))
    layers = [(0.40, 0.050, (0.46, 0.30, 0.17)), (0.49, 0.060, (0.20, 0.28, 0.29)), (0.60, 0.045, (0.075, 0.165, 0.20)),
              (0.70, 0.060, (0.55, 0.22, 0.075)), (0.755, 0.035, (0.035, 0.075, 0.11)), (0.90, 0.030, (0.015, 0.030, 0.048))]
    for k, (at, high, c) in enumerate(layers):
        line = textures.noise((1, n), 310 + k, 1.5, 1, 24)[0]
        edge = y - (at + high * line[None, :]) + 0.004 * brush
        color = textures.mix(color, textures.rgb(*c) * np.ones((n, n, 3)), textures.smooth(edge, 0, 0.012))
    sun = np.hypot((x - 0.69) * 2, y - 0.30)
    color = textures.mix(color, textures.rgb(0.74, 0.40, 0.13) * np.ones((n, n, 3)),
                         (1 - textures.smooth(sun, 0.085, 0.092)) * (y < 0.40))
    return textures.Surface(color * (1 + 0.05 * brush)[..., None], np.zeros((n, n)), (1.0, 1.0))


def evening(width=256):
    """The sky half an hour after sunset over dark hills, (h, w, 3) in shares of the brightest."""
    h = width // 2
    v, u = (np.arange(h) + 0.5) / h, (np.arange(width) + 0.5) / width
    up = np.repeat(np.cos(np.pi * v)[:, None], width, 1)
    phi = np.repeat(2 * np.pi * (u[None, :] - 0.5), h, 0)
    t = np.clip(up, 0, 1)
    sky = textures.mix(textures.rgb(0.30, 0.42, 0.62), textures.rgb(0.045, 0.095, 0.23), textures.smooth(t, 0.0, 0.55))
    glow = np.exp(-t / 0.13) * np.exp(-((phi + 1.05) / 1.0) ** 2)
    sky = sky + glow[..., None] * textures.rgb(0.95, 0.40, 0.10)
    hills = 0.045 + 0.022 * np.sin(3 * phi + 0.6) + 0.012 * np.sin(8 * phi) + 0.006 * np.sin(19 * phi + 1)
    shade = textures.smooth(hills - up, -0.006, 0.012)
    far = textures.rgb(0.020, 0.024, 0.034) * (1 - 0.6 * textures.smooth(-up, -0.05, 0.3))[..., None]
    return sky * (1 - shade[..., None]) + far * shade[..., None]


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    oak = veneer((0.50, 0.365, 0.235), (0.335, 0.22, 0.13), 101, (0.8, 1.6)).save(s.folder, "oak", normal=False)
    walnut = veneer((0.140, 0.089, 0.058), (0.060, 0.038, 0.026), 121, (0.8, 1.6), 0.35)
    walnut = walnut.save(s.folder, "walnut", normal=False)
    s.material("oak", (1, 1, 1), lambert=True, maps=oak, metres=(0.8, 1.6))
    s.material("polished walnut", (1, 1, 1), rough=0.20, maps=walnut, metres=(0.8, 1.6))
    s.material("walnut", (1, 1, 1), rough=0.42, maps=walnut, metres=(0.8, 1.6))
    s.material("carpet", (1, 1, 1), lambert=True, maps=carpet().save(s.folder, "carpet", normal=False), metres=2.0)
    s.material("painting", (1, 1, 1), lambert=True, maps=painting().save(s.folder, "painting", normal=False))
    matt("plaster", 0.74, 0.725, 0.69)
    matt("felt", 0.030, 0.029, 0.028)
    matt("wool", 0.085, 0.175, 0.200)
    matt("linen", 0.50, 0.445, 0.36, double=True)
    matt("paper", 0.70, 0.69, 0.655)
    matt("leaf", 0.075, 0.17, 0.045, double=True)
    matt("soil", 0.06, 0.045, 0.035)
    matt("lamp housing", 0.035, 0.034, 0.033)
    s.material("black steel", (0.022, 0.022, 0.023), rough=0.35)
    s.material("bronze", (0.060, 0.050, 0.042), rough=0.5)
    s.material("ceramic", (0.58, 0.56, 0.52), rough=0.30)
    s.material("pencil", (0.30, 0.045, 0.030), rough=0.4)
    s.material("pane", (1, 1, 1), glass=0, ior=1.5, thin=True)
    s.material("lamp face", (0.5, 0.5, 0.5), lambert=True, emit=WARM, strength=2500)
    for kind, luminance in FILL.items():
        s.material(f"{kind} light ceiling", (0.70, 0.69, 0.67), lambert=True, emit=SOFT, strength=luminance)
    glassware.materials(s)


# ---- the room ------------------------------------------------------------------------------------------------------
def shifted(mesh, rs):
    """Cut from another place of the veneer."""
    return mesh.with_uv(mesh.uv + rs.uniform(0, 1.6, 2).round(3))


def coffer(s):
    """A lining and a ceiling of oak in the hole, a black cylinder with the lamp's face: about the coffer's middle."""
    a, b = COFFER
    rs = np.random.RandomState(1)
    lining = []
    for k in (-1, 1):
        lining.append(shifted(chamfer((k * (a - 0.022), 3.392, -b - 0.002), (k * (a + 0.006), COFFER_TOP + 0.01, b + 0.002),
                                      0.003), rs))
        lining.append(shifted(chamfer((-a - 0.0025, 3.3925, k * (b - 0.0215)), (a + 0.0025, COFFER_TOP + 0.011,
                                                                                  k * (b + 0.0055)), 0.003), rs))
    # the grain along the boards, and along x on the coffer's ceiling
    wood = join(lining + [box((-a - 0.03, COFFER_TOP, -b - 0.03), (a + 0.03, COFFER_TOP + 0.09, b + 0.03))])
    wood = wood.with_uv(wood.uv[:, ::-1])
    housing = lathe([(0.050, 0.044), (0.050, 0), (0.054, 0), (0.055, 0.001), (0.055, COFFER_TOP - MOUTH + 0.002)], 40)
    rose = lathe([(0.050, -0.012), (0.072, -0.012), (0.074, -0.010), (0.074, 0.002)], 40).moved(
        translate(0, COFFER_TOP - MOUTH, 0))
    face = disk(0.0504, 24, up=False).moved(translate(0, 0.042, 0))
    at = translate(0, MOUTH, 0)
    for kind in FILL:
        s.mesh(f"{kind} coffer", [(wood, "oak"), (join([housing, rose]).moved(at), "lamp housing"),
                                  (face.moved(at), "lamp face"), (light_ceiling(), f"{kind} light ceiling")])


def light_ceiling():
    """White fabric, lit from behind, stretched over the coffer's ceiling except for a border of oak; the lamp hangs through it."""
    a, b, y = COFFER[0] - 0.10, COFFER[1] - 0.10, COFFER_TOP - 0.010
    return quad((-a, y, -b), (a, y, -b), (a, y, b), (-a, y, b))


def lamps(s):
    """The twenty spots, each at the mouth of its cylinder: two for the picture, eight for the table, seven for the walls;
    three, narrow and strong, come in low from the right and cast the light through carafes and glasses across the table."""
    def lamp(kind, n, x, z, target, candela, inner, outer):
        at = np.array([x, MOUTH - 0.004, z])
        s.spot(f"{kind} lamp {n}", at, np.array(target) - at, WARM, candela, inner, outer)
    for n, x in enumerate((-1, 1)):
        lamp("picture", n + 1, x, ROWS[0], (0.5 * x, 1.80, -DEPTH / 2), 1500, 12, 30)
    for n, (x, z) in enumerate([(x, z) for z in ROWS[1:] for x in (-1, 1)]):
        lamp("table", n + 1, x, z, (0.25 * x, TOP, z), 1100, 14, 38)
    accents = dict(zip(ROWS[1:4], GROUPS))
    walls = [(x, z) for z in ROWS for x in (-3, 3) if x < 0 or z not in accents]
    for n, (x, z) in enumerate(walls):
        lamp("wall", n + 1, x, z, (4 / 3 * x, 0.9, z), 2600, 10, 34)
    for n, (z, group) in enumerate(accents.items()):
        lamp("accent", n + 1, 3, z, (0.0, TOP, group), 15000, 4, 13)


def acoustic_wall(s):
    """Slats of oak before black felt, a module of 1.4 m, along x and out in +z."""
    rs = np.random.RandomState(2)
    step, slats = 0.07, []
    for k in range(20):
        x = -0.7 + step * (k + 0.5)
        slats.append(shifted(chamfer((x - 0.0215, 0.10, 0.012), (x + 0.0215, 3.31, 0.045), 0.003), rs))
    back = box((-0.7, 0.06, -0.003), (0.7, 3.35, 0.0125), "-x +x -z")
    s.mesh("acoustic wall", [(join(slats), "oak"), (back, "felt")])
    for k in range(10):
        s.place("acoustic wall", (-WIDTH / 2, 0, -6.3 + 1.4 * k), 90)


def far_wall(s):
    """Oak panels with open joints, the picture, and a sideboard below it."""
    rs = np.random.RandomState(4)
    panels, d = [], -DEPTH / 2
    for i in range(6):
        for k, (y0, y1) in enumerate(((0.10, 1.12), (1.12, 2.26), (2.26, 3.36))):
            x0 = -4 + 8 / 6 * i
            panels.append(shifted(chamfer((x0 + 0.004, y0 + 0.004, d + 0.008),
                                          (x0 + 8 / 6 - 0.004, y1 - 0.004, d + 0.026), 0.002), rs))
    s.mesh("panelling", [(join(panels), "oak"), (box((-4.02, 0.05, d - 0.004), (4.02, 3.38, d + 0.012), "-z"), "felt")])
    s.place("panelling")
    w, h = 1.70, 0.82
    image = quad((-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0))
    image = image.with_uv(np.array([(0, 1), (1, 1), (1, 0), (0, 0)], float)).moved(translate(0, 0, 0.034))
    bars = [chamfer((k * w, -h - 0.02, 0), (k * (w + 0.018), h + 0.02, 0.05), 0.003) for k in (-1, 1)]
    bars += [chamfer((-w - 0.0005, k * h, 0.0003), (w + 0.0005, k * (h + 0.018), 0.0497), 0.003) for k in (-1, 1)]
    bars.append(box((-w - 0.002, -h - 0.002, 0.001), (w + 0.002, h + 0.002, 0.0335)))
    s.mesh("picture", [(image, "painting"), (join(bars), "black steel")])
    s.place("picture", (0, 1.86, d + 0.024))
    doors = [shifted(chamfer((-1.79 + 0.60 * k, 0.12, 0.40), (-1.79 + 0.60 * k + 0.58, 0.66, 0.425), 0.002), rs)
             for k in range(6)]
    case = [planar_uv(chamfer((-1.81, 0.08, 0), (1.81, 0.70, 0.405), 0.003)),
            planar_uv(chamfer((-1.83, 0.698, -0.01), (1.83, 0.725, 0.435), 0.004))]
    s.mesh("sideboard", [(join(doors + case), "walnut"), (box((-1.70, -0.001, 0.06), (1.70, 0.085, 0.36)), "black steel")])
    s.place("sideboard", (0, 0, d + 0.024))
    pot, soil = f.pot(0.13, 0.22)
    plant = f.plant(np.random.RandomState(6), 26, 0.50, 0.06, 0.7).moved(translate(0, 0.19, 0))
    s.mesh("plant", [(pot, "ceramic"), (soil, "soil"), (plant, "leaf")])
    s.place("plant", (1.45, 0.7245, d + 0.24), 30)
    s.mesh("vase", [(f.vase(0.30), "ceramic")])
    s.mesh("bowl", [(f.bowl(0.17, 0.075), "ceramic")])
    s.place("vase", (-1.50, 0.7245, d + 0.22))
    s.place("bowl", (-1.12, 0.7245, d + 0.25))


def windows(s):
    """Five windows with panes, a sill along all of them, curtains before the piers."""
    w = WIDTH / 2
    frame = rooms.window(2 * WINDOW, HEAD - SILL, 2, 1, 0.05, 0.04, 0.07)
    y = HEAD - SILL
    pane = quad((0.02, 0.02, 0), (2 * WINDOW - 0.02, 0.02, 0), (2 * WINDOW - 0.02, y - 0.02, 0), (0.02, y - 0.02, 0))
    s.mesh("window", [(frame, "bronze"), (pane, "pane")])
    for z in ROWS:
        s.place("window", (w + 0.20, SILL, z - WINDOW), -90)
    rs = np.random.RandomState(5)
    sill = shifted(chamfer((w - 0.06, SILL - 0.03, -6.98), (w + 0.19, SILL + 0.004, 6.98), 0.004), rs)
    s.mesh("sill", [(sill, "oak")])
    s.place("sill")
    for name, half, folds, seed in (("curtain", 0.34, 7, 1), ("narrow curtain", 0.16, 3, 2)):
        s.mesh(name, [(curtain(half, folds, seed), "linen")])
    for z in (-4.2, -1.4, 1.4, 4.2):
        s.place("curtain", (w - 0.155, 0, z))
    for z in (-6.80, 6.80):
        s.place("narrow curtain", (w - 0.155, 0, z))
    s.mesh("curtain rail", [(chamfer((w - 0.175, 3.345, -6.96), (w - 0.135, 3.372, 6.96), 0.003), "bronze")])
    s.place("curtain rail")


def curtain(half, folds, seed):
    """A gathered curtain along z about the origin, in folds along x that open a little downwards."""
    rs = np.random.RandomState(seed)
    u, y = np.linspace(-1, 1, folds * 14 + 1)[:, None], np.linspace(0.015, 3.35, 9)[None, :]
    down = 1 - y / 3.35
    phase = np.pi * folds * u + rs.uniform(0, 6) + 0.25 * np.sin(2.3 * u + 1.5 * down)
    deep = 0.036 * (1 + 0.35 * np.sin(3.1 * u + rs.uniform(0, 6))) * (0.75 + 0.35 * down)
    x = deep * np.sin(phase) + 0.006 * np.sin(2 * phase + 2 * down)
    z = half * u * (0.92 + 0.08 * down) + 0.004 * np.sin(2 * phase)
    m = grid(np.stack([x, y + 0 * u, z + 0 * y], 2))
    return m if m.n[:, 0].sum() < 0 else m.flipped()


def architecture(s):
    w, d = WIDTH / 2, DEPTH / 2
    holes = {"+x": [(z - WINDOW, z + WINDOW, SILL, HEAD) for z in ROWS],
             "ceiling": [(x - COFFER[0], x + COFFER[0], z - COFFER[1], z + COFFER[1]) for x in COLUMNS for z in ROWS]}
    sh = rooms.shell(WIDTH, DEPTH, HEIGHT, 0.32, holes)
    s.mesh("walls", [(join([sh[k] for k in ("-x", "+x", "-z", "+z")]), "plaster")])
    s.mesh("ceiling", [(sh["ceiling"], "plaster")])
    s.mesh("floor", [(sh["floor"], "carpet")])
    for name in ("walls", "ceiling", "floor"):
        s.place(name)
    coffer(s)
    for x in COLUMNS:
        for z in ROWS:
            s.place("middle coffer" if abs(x) < 2 else "outer coffer", (x, 0, z))
    s.mesh("skirting", [(rooms.skirting(WIDTH, DEPTH, 0.09, 0.014), "bronze")])
    s.place("skirting")
    leaf, knobs = rooms.door(0.95, 2.20)
    s.mesh("door", [(join([leaf.moved(translate(0.01, 0.002, 0.012)), rooms.architrave(0.97, 2.21, 0.07, 0.03)]), "walnut"),
                    (knobs.moved(translate(0.01, 0, 0.012)), "bronze")])
    s.place("door", (2.6, 0, d), 180)
    acoustic_wall(s)
    far_wall(s)
    windows(s)


# ---- table and chairs ----------------------------------------------------------------------------------------------
def reach(z):
    """Half the table's width at z."""
    a, b = TABLE
    return a * (1 - np.minimum(abs(z) / b, 1) ** 3.2) ** (1 / 3.2)


def table(s):
    """A boat-shaped top, 40 mm thick with a round edge, on three pedestals."""
    a, b = TABLE
    t = np.linspace(-np.pi / 2, np.pi / 2, 8001)
    x, z = a * np.abs(np.cos(t)) ** (2 / 3.2), b * np.sign(np.sin(t)) * np.abs(np.sin(t)) ** (2 / 3.2)
    x[0] = x[-1] = 0
    run = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(z)))])
    at = np.linspace(0, run[-1], 141)
    x, z = np.interp(at, run, x), np.interp(at, run, z)
    x, z = (x + x[::-1]) / 2, (z - z[::-1]) / 2
    n = np.stack([np.abs(x / a) ** 2.2 / a, np.sign(z) * np.abs(z / b) ** 2.2 / b], 1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    loop = np.concatenate([np.stack([x, z], 1), np.stack([-x, z], 1)[-2::-1]])
    nl = np.concatenate([n, (n * (-1, 1))[-2::-1]])
    r = 0.020
    turn = np.radians(np.linspace(90, -90, 15))[:, None]
    inset, y, up, out = r * (1 - np.cos(turn)), TOP - r + r * np.sin(turn), np.sin(turn), np.cos(turn)
    inset[0] = inset[-1] = r
    p = np.stack([loop[:, 0] - inset * nl[:, 0], y + 0 * loop[:, 0], loop[:, 1] - inset * nl[:, 1]], 2)
    normal = np.stack([out * nl[:, 0], up + 0 * loop[:, 0], out * nl[:, 1]], 2)
    edge = facing(grid(p, normal.reshape(-1, 3)))
    edge = edge.with_uv(np.stack([edge.p[:, 0] - (edge.p[:, 1] - TOP) * np.sign(edge.p[:, 0]), edge.p[:, 2]], 1))
    parts = [edge]
    for row, sign in ((0, 1), (-1, -1)):
        k = len(x)
        pair = np.stack([p[row, :k], np.concatenate([p[row, k:][::-1], p[row, k - 1:k]])], 1)
        pair[:, :, 1] = TOP if sign > 0 else TOP - 2 * r
        m = facing(grid(pair, np.tile([0.0, sign, 0.0], (2 * k, 1))))
        parts.append(m.with_uv(m.p[:, [0, 2]]))
    s.mesh("table", [(join(parts), "polished walnut")])
    s.place("table")
    base = [chamfer((-0.26, 0.03, -0.30), (0.26, TOP - 0.039, 0.30), 0.006),
            chamfer((-0.34, -0.001, -0.42), (0.34, 0.034, 0.42), 0.006)]
    s.mesh("pedestal", [(join(base), "black steel")])
    for z in (-2.15, 0, 2.15):
        s.place("pedestal", (0, 0, z))


def chair():
    """(upholstery, frame) of an armchair on a sledge of bent tube, its seat's middle over the origin, facing +z."""
    def bent(q):
        return np.stack([q[:, 0], q[:, 1], q[:, 2] + 0.75 * q[:, 0] ** 2 + 0.22 * (q[:, 1] + 0.1) ** 2], 1)
    seat = superquadric((0.245, 0.048, 0.250), 0.26, 0.62, 40, 14).moved(translate(0, 0.435, 0.005) @ rotate("x", -2))
    back = deformed(superquadric((0.240, 0.042, 0.235), 0.28, 0.66, 40, 14).moved(rotate("x", 90)), bent)
    back = back.moved(translate(0, 0.715, -0.262) @ rotate("x", -11))
    frame = []
    for x in (-0.272, 0.272):
        frame.append(f.tube([(x * 0.93, 0.655, -0.255), (x, 0.655, -0.20), (x, 0.655, 0.215), (x, 0.0115, 0.275),
                             (x, 0.0115, -0.270), (0, 0.0115, -0.270)], 0.0115, 10, 0.07, 6))
        frame.append(chamfer((x - 0.020, 0.664, -0.15), (x + 0.020, 0.684, 0.17), 0.006))
    frame.append(f.bar((-0.272, 0.395, 0.2385), (0.272, 0.395, 0.2385), 0.0100, 10))
    frame.append(f.bar((-0.250, 0.655, -0.2585), (0.250, 0.655, -0.2585), 0.0095, 10))
    frame.append(chamfer((-0.16, 0.378, -0.245), (-0.13, 0.396, 0.245), 0.003))
    frame.append(chamfer((0.13, 0.378, -0.245), (0.16, 0.396, 0.245), 0.003))
    return join([seat, back]), join(frame)


def seats(s):
    """Sixteen chairs, and before each a pad of paper, a pencil and a glass."""
    rs = np.random.RandomState(12)
    upholstery, frame = chair()
    s.mesh("chair", [(upholstery, "wool"), (frame, "black steel")])
    pad = chamfer((-0.105, 0, -0.148), (0.105, 0.007, 0.148), 0.0008)
    s.mesh("pad", [(pad, "paper")])
    body, tip = f.pencil()
    s.mesh("pencil", [(body, "pencil"), (tip, "oak")])
    places = [(side * reach(z), z, -90 * side) for z in 0.86 * np.arange(-3, 4) for side in (-1, 1)]
    places += [(0, k * TABLE[1], 180 if k > 0 else 0) for k in (-1, 1)]
    for k, (x, z, yaw) in enumerate(places):
        turn = np.radians(yaw)
        ahead, right = np.array([np.sin(turn), np.cos(turn)]), np.array([-np.cos(turn), np.sin(turn)])
        edge = np.array([x, z])
        def put(name, forward, side, y, spin=0.0, edge=edge, ahead=ahead, right=right, yaw=yaw):
            q = edge + forward * ahead + side * right
            s.place(name, (q[0], y, q[1]), yaw + spin)
        back, spin = 0.21 + rs.uniform(-0.03, 0.05), rs.uniform(-5, 5)
        if k == 13:
            back, spin = 0.42, 38.0   # this chair is pushed back
        put("chair", -back, rs.uniform(-0.02, 0.02), 0.0, spin)
        put("pad", 0.22, -0.02, TOP - 0.0005, rs.uniform(-6, 6))
        put("pencil", 0.22 + rs.uniform(-0.01, 0.01), 0.115, TOP - 0.0004, 90 + rs.uniform(-12, 12))
        put("full glass" if k % 3 == 1 else "glass", 0.40, 0.12 + rs.uniform(-0.02, 0.02), TOP, rs.uniform(0, 45))


def drinks(s):
    for name, parts in (("carafe", glassware.carafe(0.112)), ("low carafe", glassware.carafe(0.058)),
                        ("glass", glassware.tumbler()), ("full glass", glassware.tumbler(0.058))):
        s.mesh(name, parts)
    groups = ((("low carafe", 0.07, -0.10, 40), ("carafe", -0.10, 0.06, 3), ("full glass", 0.09, 0.12, 22)),
              (("carafe", 0.02, -0.16, 10), ("low carafe", 0.20, -0.02, 31), ("full glass", -0.02, 0.08, 5),
               ("glass", 0.14, 0.15, 20), ("glass", -0.20, -0.02, 50)),
              (("carafe", 0.05, 0.04, 15), ("glass", -0.10, -0.08, 5)))
    for z, things in zip(GROUPS, groups):
        for name, x, dz, yaw in things:
            s.place(name, (x, TOP, z + dz), yaw)


def main():
    s = Scene("conference")
    materials(s)
    architecture(s)
    table(s)
    drinks(s)
    seats(s)
    lamps(s)
    hdr(os.path.join(s.folder, "sky.hdr"), evening())
    s.camera("main", (-0.72, 1.56, 6.10), (0.08, 1.56, -7.0), yfov=47.0)
    s.camera("table", (0.30, 1.22, GROUPS[1] + 1.02), (-0.03, 0.825, GROUPS[1] - 0.04), yfov=27.0)
    s.write("A meeting hall in the evening under twenty spot lights in a coffered ceiling, with carafes, glasses and water "
            "on a long dark table: what the spots, which are points, send through solid glass is a caustic that photons alone find "
            "(camera table: close to it).",
            {"film.ev": -4.9, "components.tertiary": "photons", "components.caustic": "photons", "environment": {"file": "sky.hdr", "scale": 45}})


if __name__ == "__main__":
    main()
