"""A covered street of shops at night (`arcade`): a thousand lamps under a vault of iron and glass.

x to the right, y up; the street runs along z. Eleven bays of arched shop fronts on either side carry a storey of windows and
a glazed barrel vault; a clock closes the far end. Lamps are festoons of bulbs across the street, bulbs along both cornices,
ring chandeliers, globes on brackets, spots in the windows, lettering and rings of glass tube, lit rooms, candles. Radiance is in
W/(m^2 sr) and spots in W/sr, each lamp as strong as a real one: radiant power of what is visible, of a festoon's bulb 0.5 W, of
a bracket's globe 4 W, of a window's spot 7 to 14 W, some 2 kW in all. Openings have no panes (light through glass would be a
caustic) but in the vault, where glass is night-blue, shines as dimly as the sky an hour after sunset and mirrors the street.
"""
import numpy as np

import arcade_shops as shops
import atrium_parts as ap
import furniture
from gltf import Mesh, Scene, join
from shapes import box, chamfer, disk, facing, lathe, quad, rotate, slab, sphere, sweep, translate

BAY, BAYS = 3.4, 11
LENGTH = BAY * BAYS
Z_NEAR, Z_FAR = LENGTH / 2, -LENGTH / 2
HALF, WALL = 3.6, 0.5            # the street's half width between walls, their thickness
LEVEL, FLOOR2 = 4.40, 4.78       # top of the lower wall; the string course's upper edge
SILL2, SPRING2, TOP = 5.42, 6.25, 7.50
VAULT_Y, VAULT_R = 7.40, 3.72    # the vault's axis and radius
PANES = 14                       # around the vault
AMBER, WARM, SOFT, WHITE = (1.0, 0.62, 0.30), (1.0, 0.72, 0.44), (1.0, 0.82, 0.62), (1.0, 0.93, 0.84)

# bays from the near end: kind of shop, its word and the word's colour, on the right and on the left side
RIGHT = [("flowers", "FIORI", "green"), ("books", "LIBRI", "amber"), ("pastry", "DOLCI", "rose"), ("lamps", "LUCE", "ice"),
         ("clothes", "MODA", "violet"), ("wines", "VINO", "red"), ("jewels", "ORO", "amber"), ("ceramics", "TERRA", "ice"),
         ("books", "CARTE", "green"), ("lamps", "LUMI", "rose"), ("flowers", "ROSA", "red")]
LEFT = [("jewels", "PERLE", "ice"), ("clothes", "SETA", "rose"), ("wines", "BAR", "red"), ("ceramics", "VASI", "green"),
        ("lamps", "STELLE", "amber"), ("books", "ARTE", "ice"), ("pastry", "CAFE", "amber"), ("flowers", "GIGLI", "violet"),
        ("clothes", "TINTA", "ice"), ("jewels", "GEMME", "green"), ("wines", "OSTE", "red")]
DOORS = {1, 4, 7, 9}             # bays whose front is open down to the pavement on its left
TUBES = {"amber": (1.0, 0.50, 0.10), "rose": (1.0, 0.16, 0.36), "red": (1.0, 0.09, 0.05), "ice": (0.25, 0.72, 1.0),
         "green": (0.22, 1.0, 0.42), "violet": (0.55, 0.25, 1.0)}


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    matt("stucco", 0.66, 0.585, 0.485)
    matt("pale stone", 0.74, 0.68, 0.57)
    matt("upper wall", 0.60, 0.52, 0.41)
    for k, c in enumerate(((0.62, 0.56, 0.46), (0.55, 0.49, 0.40), (0.66, 0.61, 0.52))):
        s.material(f"floor stone {k}", c, rough=0.19)
    s.material("dark floor stone", (0.075, 0.060, 0.052), rough=0.18)
    s.material("red floor stone", (0.30, 0.115, 0.075), rough=0.20)
    s.material("green marble", (0.055, 0.115, 0.085), rough=0.22)
    s.material("bronze", (0.165, 0.105, 0.060), rough=0.42)
    s.material("brass", (0.80, 0.56, 0.26), rough=0.32, metal=1.0)
    s.material("gold", (1.0, 0.72, 0.32), rough=0.22, metal=1.0)
    s.material("iron", (0.030, 0.042, 0.040), rough=0.5)
    s.material("night glass", (0.006, 0.008, 0.014), rough=0.06, emit=(0.30, 0.48, 1.0), strength=0.035)
    matt("shop floor", 0.32, 0.22, 0.14)
    matt("fascia", 0.018, 0.020, 0.024)
    for name, c in (("plum shop", (0.34, 0.15, 0.17)), ("sage shop", (0.36, 0.42, 0.33)), ("sand shop", (0.66, 0.56, 0.42)),
                    ("navy shop", (0.10, 0.14, 0.25)), ("white shop", (0.74, 0.71, 0.65))):
        matt(name, *c)
    s.material("dark wood", (0.17, 0.090, 0.048), rough=0.4)
    for name, c in (("celadon", (0.36, 0.55, 0.45)), ("cobalt", (0.04, 0.10, 0.42)), ("cream", (0.72, 0.66, 0.54)),
                    ("oxblood", (0.38, 0.045, 0.03))):
        s.material(name, c, rough=0.25)
    for name, c in (("bottle green", (0.025, 0.075, 0.03)), ("bottle red", (0.13, 0.012, 0.014))):
        s.material(name, c, rough=0.12)
    matt("terracotta", 0.52, 0.24, 0.13), matt("soil", 0.07, 0.05, 0.035), matt("crust", 0.56, 0.33, 0.14)
    matt("ochre", 0.62, 0.40, 0.12), matt("velvet", 0.13, 0.016, 0.03)
    for name, c in (("leaves", (0.10, 0.27, 0.06)), ("rose petals", (0.80, 0.16, 0.24)), ("yellow petals", (0.85, 0.62, 0.08)),
                    ("white petals", (0.85, 0.82, 0.76)), ("red cloth", (0.55, 0.05, 0.04)), ("green cloth", (0.06, 0.26, 0.12)),
                    ("blue cloth", (0.06, 0.15, 0.48)), ("saffron cloth", (0.74, 0.40, 0.06)), ("rose silk", (0.72, 0.25, 0.32))):
        matt(name, *c, double=True)
    s.material("black steel", (0.02, 0.02, 0.021), rough=0.4)

    def lamp(name, color, radiance):
        s.material(name, (0.5, 0.5, 0.5), lambert=True, emit=color, strength=radiance)
    lamp("festoon bulb", WARM, 20.0)        # radius 26 mm: 0.5 W
    lamp("cornice bulb", WARM, 14.0)         # 20 mm: 0.2 W
    lamp("globe", SOFT, 9.0)                 # of brackets, 0.10 m: 3.6 W
    lamp("chandelier globe", SOFT, 10.0)
    lamp("opal", WHITE, 6.0), lamp("amber opal", AMBER, 6.0), lamp("rose opal", (1.0, 0.36, 0.30), 5.0)
    lamp("strip", WHITE, 10.0)               # along a shop's lintel
    lamp("candle", (1.0, 0.45, 0.13), 60.0)
    lamp("clock face", WHITE, 2.6)
    lamp("fanlight", (1.0, 0.62, 0.30), 0.9)
    for k, (c, strength) in enumerate((((1.0, 0.62, 0.30), 1.1), ((1.0, 0.72, 0.44), 0.7), ((1.0, 0.52, 0.22), 0.5),
                                       ((0.72, 0.84, 1.0), 0.35))):
        lamp(f"lit room {k}", c, strength)
    for name, c in TUBES.items():
        lamp(f"{name} tube", c, 14.0)


def sides():
    """(sign of x, yaw that turns a part facing +z towards the street)."""
    return ((1, -90.0), (-1, 90.0))


def bays():
    return [Z_NEAR - BAY * (i + 0.5) for i in range(BAYS)]


def piers():
    return [Z_NEAR - BAY * i for i in range(BAYS + 1)]


def on_wall(x):
    """x of the middle of the wall on that side."""
    return x * (HALF + WALL / 2)


# ---- stone ---------------------------------------------------------------------------------------------------------
def walls(s):
    spring = shops.TRANSOM + 0.03
    lower = ap.arch_panel(BAY, -0.05, spring, LEVEL + 0.05, shops.RADIUS, WALL, 26)
    front = WALL / 2
    trim = [ap.archivolt(shops.RADIUS, 0.22, 0.05, front, 24).moved(translate(0, spring, 0)),
            ap.keystone(shops.RADIUS, 0.22, 0.05, front).moved(translate(0, spring, 0))]
    for k in (-1, 1):
        a, b = shops.RADIUS, shops.RADIUS + 0.20
        trim.append(chamfer((k * a, -0.002, front - 0.01), (k * b, spring - 0.16, front + 0.035), 0.008))
        trim.append(chamfer((k * (a - 0.012), spring - 0.17, front - 0.012), (k * (b + 0.03), spring + 0.005, front + 0.06), 0.012))
    s.mesh("front wall", [(lower, "stucco"), (join(trim), "pale stone")])
    upper = [ap.arch_panel(BAY, SILL2, SPRING2, TOP, 0.60, WALL, 20), box((-BAY / 2, LEVEL - 0.02, -WALL / 2),
                                                                         (BAY / 2, SILL2, WALL / 2), "-x +x")]
    trim = [ap.archivolt(0.60, 0.15, 0.045, front, 18).moved(translate(0, SPRING2, 0)),
            ap.keystone(0.60, 0.15, 0.045, front).moved(translate(0, SPRING2, 0)),
            chamfer((-0.86, SILL2 - 0.10, front - 0.01), (0.86, SILL2 + 0.01, front + 0.12), 0.015)]
    for k in (-1, 1):
        trim.append(chamfer((k * 0.60, SILL2, front - 0.01), (k * 0.74, SPRING2, front + 0.03), 0.008))
        for x in (1.05,):
            trim.append(chamfer((k * x, SILL2 + 0.1, front - 0.01), (k * (x + 0.34), SPRING2 + 0.42, front + 0.022), 0.012))
    frame = [chamfer((-0.62, y - 0.02, -0.10), (0.62, y + 0.02, -0.04), 0.006) for y in (SILL2 + 0.02, SILL2 + 0.45, SPRING2)]
    frame += [chamfer((x - 0.02, SILL2, -0.10), (x + 0.02, SPRING2 + 0.58, -0.04), 0.006) for x in (-0.58, 0.0, 0.58)]
    s.mesh("upper wall", [(join(upper), "upper wall"), (join(trim), "pale stone"), (join(frame), "bronze")])
    course = [(0, 0), (0.05, 0.02), (0.05, 0.09), (0.12, 0.16), (0.20, 0.22), (0.30, 0.25), (0.30, 0.33), (0, FLOOR2 - LEVEL)]
    crown = [(0, 0), (0.04, 0.03), (0.04, 0.12), (0.12, 0.20), (0.22, 0.26), (0.28, 0.28), (0.28, 0.37), (0, 0.42)]
    s.mesh("string course", [(ap.cornice(BAY, course, 0.17).moved(translate(0, LEVEL, front)), "pale stone")])
    s.mesh("crown", [(ap.cornice(BAY, crown, 0.17).moved(translate(0, 6.98, front)), "pale stone")])
    pilaster = [chamfer((-0.21, 0.52, -0.01), (0.21, 3.80, 0.10), 0.012), chamfer((-0.26, -0.002, -0.012), (0.26, 0.44, 0.15), 0.014),
                chamfer((-0.24, 0.43, -0.011), (0.24, 0.53, 0.125), 0.012),
                chamfer((-0.14, 0.72, 0.09), (0.14, 3.62, 0.112), 0.006), chamfer((-0.235, 3.79, -0.012), (0.235, 3.87, 0.13), 0.012),
                chamfer((-0.22, 3.86, -0.011), (0.22, 4.14, 0.115), 0.010),
                chamfer((-0.26, 4.13, -0.013), (0.26, 4.22, 0.16), 0.012), chamfer((-0.31, 4.21, -0.014), (0.31, LEVEL + 0.01, 0.21), 0.014)]
    small = [chamfer((-0.17, FLOOR2 + 0.20, -0.01), (0.17, 6.78, 0.075), 0.010), chamfer((-0.21, FLOOR2 - 0.02, -0.012), (0.21, FLOOR2 + 0.21, 0.11), 0.012),
             chamfer((-0.20, 6.77, -0.011), (0.20, 6.86, 0.10), 0.010), chamfer((-0.25, 6.85, -0.012), (0.25, 6.99, 0.15), 0.012)]
    s.mesh("pilaster", [(join(pilaster + small), "pale stone")])
    rail = [furniture.bar((-1.30, 0.62, 0.16), (1.30, 0.62, 0.16), 0.016, 8), furniture.bar((-1.30, 0.10, 0.16), (1.30, 0.10, 0.16), 0.011, 6)]
    rail += [furniture.bar((x, 0.0, 0.16), (x, 0.62, 0.16), 0.007, 5) for x in np.linspace(-1.3, 1.3, 21)]
    s.mesh("railing", [(join(rail).moved(translate(0, FLOOR2 - 0.02, front)), "iron")])
    pane = quad((-0.66, SILL2 - 0.03, -0.16), (0.66, SILL2 - 0.03, -0.16), (0.66, SPRING2 + 0.64, -0.16), (-0.66, SPRING2 + 0.64, -0.16))
    back = box((-0.70, SILL2 - 0.06, -0.40), (0.70, SPRING2 + 0.68, -0.17))
    for k in range(4):
        s.mesh(f"lit window {k}", [(pane, f"lit room {k}"), (back, "fascia")])
    s.mesh("dark window", [(pane, "night glass"), (back, "fascia")])
    # behind everything, so that no light passes the seams between bays
    outer, length = HALF + WALL / 2 + shops.DEEP + 0.7, LENGTH + 1.0
    s.mesh("casing", [(join([box((HALF + WALL - 0.04, LEVEL - 0.1, -length / 2), (HALF + WALL + 0.3, TOP + 0.4, length / 2)),
                             box((HALF + 0.10, TOP - 0.08, -length / 2), (HALF + WALL + 0.3, TOP + 0.3, length / 2)),
                             box((HALF + 0.04, shops.HIGH + 0.18, -length / 2), (outer, LEVEL + 0.03, length / 2)),
                             box((outer - 0.62, -0.5, -length / 2), (outer, LEVEL, length / 2))]), "fascia")])
    for turn in (0, 180):
        s.place("casing", (0, 0, 0), turn)
    rooms = [0, 2, 4, 1, 3, 0, 1, 4, 2, 0, 1], [1, 4, 0, 2, 0, 4, 1, 0, 3, 1, 2]
    for side, (x, yaw) in enumerate(sides()):
        for i, z in enumerate(bays()):
            at = (on_wall(x), 0, z)
            for part in ("front wall", "upper wall", "string course", "crown", "railing"):
                s.place(part, at, yaw)
            k = rooms[side][i]
            s.place("dark window" if k == 4 else f"lit window {k}", at, yaw)
        for z in piers():
            s.place("pilaster", (x * HALF, 0, z), yaw)


def tilted(mesh, rs, amount):
    """A flat part whose normals lean by about `amount`: nothing laid by hand is level."""
    n = mesh.n + np.array([rs.normal(0, amount), 0, rs.normal(0, amount)])
    return Mesh(mesh.p, n / np.linalg.norm(n, axis=1, keepdims=True), mesh.uv, mesh.t)


def pavement(s):
    wide = HALF + shops.DEEP + 1.0
    s.mesh("ground", [(box((-wide, -0.6, Z_FAR - 1.0), (wide, -0.012, Z_NEAR + 1.0)), "dark floor stone")])
    rs = np.random.RandomState(12)
    tile, joint = 0.90, 0.0025
    field = 3.15
    tones = {f"floor stone {k}": [] for k in range(3)}
    dark, red = [], []

    def flag(x0, x1, z0, z1, y=0.0):
        return tilted(quad((x0, y, z1), (x1, y, z1), (x1, y, z0), (x0, y, z0)), rs, 0.0022)
    xs, zs = np.arange(-field, field - 0.01, tile), np.arange(Z_FAR, Z_NEAR - 0.01, tile)
    for x in xs:
        for z in zs:
            tones[f"floor stone {rs.randint(3)}"].append(flag(x + joint, x + tile - joint, z + joint, z + tile - joint))
    for x in np.append(xs, field)[1:-1]:
        for k, z in enumerate(zs[1:]):
            h = 0.155
            d = quad((x, 0.0006, z + h), (x + h, 0.0006, z), (x, 0.0006, z - h), (x - h, 0.0006, z))
            (red if (k + int(round(x / tile))) % 3 == 0 else dark).append(tilted(d, rs, 0.002))
    for k in (-1, 1):
        for z in np.arange(Z_FAR, Z_NEAR, 1.7):
            a, b = sorted((k * (field + joint), k * (HALF + 0.06)))
            dark.append(flag(a, b, z + joint, z + 1.7 - joint))
        a, b = sorted((k * (field - 0.20), k * (field - 0.10)))
        red.append(flag(a, b, Z_FAR, Z_NEAR, 0.0006))
    s.mesh("pavement", [(join(v), n) for n, v in tones.items()] + [(join(dark), "dark floor stone"), (join(red), "red floor stone")])
    s.place("ground"), s.place("pavement")


def on_arc(r, degrees):
    a = np.radians(degrees)
    return np.array([r * np.cos(a), VAULT_Y + r * np.sin(a), 0.0])


def vault(s):
    """Flat panes between ribs and purlins of iron: one bay; ends of the street are closed by walls that reach over it."""
    angles = np.linspace(0, 180, PANES + 1)
    panes, bars = [], []
    for a, b in zip(angles[:-1], angles[1:]):
        p, q = on_arc(VAULT_R, a), on_arc(VAULT_R, b)
        z = np.array([0, 0, BAY / 2 + 0.001])
        panes.append(facing(quad(p - z, p + z, q + z, q - z), None))
    glass = join(panes)
    # seen from below
    centre = np.array([0, VAULT_Y, 0])
    if np.dot(glass.n[0], centre - glass.p[0]) < 0:
        glass = glass.flipped()
    for a in angles[1:-1]:
        p, d = on_arc(VAULT_R - 0.035, a), a - 90
        m = translate(*p) @ rotate("z", d)
        bars.append(box((-0.022, -0.03, -BAY / 2), (0.022, 0.045, BAY / 2), "-z +z").moved(m))
    for z in (-BAY / 4, 0.0, BAY / 4):
        path = [on_arc(VAULT_R - 0.03, a) + [0, 0, z] for a in angles]
        bars.append(furniture.tube(path, 0.018, 6, 0.02, 1))
    s.mesh("vault", [(glass, "night glass"), (join(bars), "iron")])
    fine = np.linspace(0, 180, 45)
    arc = np.array([on_arc(1.0, a) - [0, VAULT_Y, 0] for a in fine])
    frames = (arc, np.tile([0.0, 0, 1], (len(arc), 1)))
    rib = []
    for r0, r1, half in ((VAULT_R - 0.06, VAULT_R + 0.02, 0.075), (VAULT_R - 0.42, VAULT_R - 0.35, 0.065)):
        path = np.array([on_arc(0.0, 0)] * len(arc))
        rib.append(facing(sweep([(r0, -half), (r1, -half), (r1, half), (r0, half), (r0, -half)], path, frames)))
    for k in range(13):
        a = 7 + 166 / 12 * k
        rib.append(shops.ring(0.112, 0.014, 14, 4).moved(translate(*on_arc(VAULT_R - 0.205, a)) @ rotate("z", a)))
    s.mesh("rib", [(join(rib), "iron")])
    for z in bays():
        s.place("vault", (0, 0, z))
    for z in piers():
        s.place("rib", (0, 0, z))


def ends(s):
    """The wall at the far end with its portal and clock, and a plain one behind the camera."""
    wide, high = HALF + WALL / 2 + shops.DEEP + 0.8, VAULT_Y + VAULT_R + 0.3
    r, spring = 1.75, 3.0
    portal = ap.arch_panel(2 * wide, -0.1, spring, high, r, 0.6, 36)
    trim = [ap.archivolt(r, 0.34, 0.09, 0.30, 36).moved(translate(0, spring, 0)), ap.keystone(r, 0.34, 0.09, 0.30).moved(translate(0, spring, 0)),
            chamfer((-2.35, 5.28, 0.29), (2.35, 5.40, 0.42), 0.015), chamfer((-2.45, 5.39, 0.29), (2.45, 5.50, 0.50), 0.015)]
    for k in (-1, 1):
        trim.append(chamfer((k * r, -0.002, 0.29), (k * (r + 0.32), spring - 0.14, 0.37), 0.012))
        trim.append(chamfer((k * (r - 0.015), spring - 0.15, 0.29), (k * (r + 0.37), spring + 0.01, 0.42), 0.014))
    clock_y = 7.05
    rim = lathe([(1.06, 0.0), (1.06, 0.10), (0.98, 0.14), (0.90, 0.10), (0.86, 0.12), (0.80, 0.05), (0.80, 0.0)], 48).moved(
        translate(0, clock_y, 0.30) @ rotate("x", 90))
    face = disk(0.81, 48).moved(translate(0, clock_y, 0.325) @ rotate("x", 90))
    marks = [chamfer((-0.016, 0.62, 0), (0.016, 0.75, 0.012), 0.002).moved(translate(0, clock_y, 0.33) @ rotate("z", 30.0 * k)) for k in range(12)]
    for angle, length, wide_hand in ((-305.0, 0.42, 0.030), (-48.0, 0.66, 0.020)):
        marks.append(chamfer((-wide_hand, -0.10, 0), (wide_hand, length, 0.012), 0.004).moved(translate(0, clock_y, 0.35) @ rotate("z", angle)))
    marks.append(lathe([(0, 0.03), (0.05, 0.03), (0.05, 0.0)], 16).moved(translate(0, clock_y, 0.33) @ rotate("x", 90)))
    fan = quad((-r - 0.1, spring, -0.22), (r + 0.1, spring, -0.22), (r + 0.1, spring + r + 0.1, -0.22), (-r - 0.1, spring + r + 0.1, -0.22))
    bars = [chamfer((-r - 0.02, spring - 0.09, -0.25), (r + 0.02, spring + 0.05, -0.10), 0.01)]
    for k in range(1, 8):
        a = np.radians(22.5 * k)
        bars.append(furniture.bar((0.4 * np.cos(a), spring + 0.4 * np.sin(a), -0.17), (r * np.cos(a), spring + r * np.sin(a), -0.17), 0.022, 6))
    for q in (0.42, 1.10):
        bars.append(furniture.tube([(q * np.cos(a), spring + q * np.sin(a), -0.17) for a in np.radians(np.linspace(0, 180, 17))], 0.022, 6, 0.03, 1))
    doors = []
    for k in (-1, 1):
        doors.append(chamfer((k * 0.012, 0.01, -0.24), (k * (r + 0.02), spring - 0.05, -0.16), 0.008))
        for y0, y1 in ((0.2, 0.95), (1.08, 2.78)):
            for x0, x1 in ((0.14, 0.80), (0.92, 1.60)):
                doors.append(chamfer((k * x0, y0, -0.17), (k * x1, y1, -0.135), 0.014))
    back = box((-wide, -0.2, -0.75), (wide, high, -0.26))
    s.mesh("far wall", [(join([portal, back]), "stucco"), (join(trim + [rim]), "pale stone"), (face, "clock face"),
                        (join(marks), "black steel"), (fan, "fanlight"), (join(bars), "iron"), (join(doors), "bronze")])
    s.place("far wall", (0, 0, Z_FAR + 0.05))
    s.mesh("near wall", [(box((-wide, -0.2, -0.6), (wide, high, 0.0)), "stucco")])
    s.place("near wall", (0, 0, Z_NEAR - 0.05), 180)
    round_bulbs = [(1.99 * np.cos(a), spring + 1.99 * np.sin(a), 0.425) for a in np.radians(np.linspace(4, 176, 24)) if abs(a - np.pi / 2) > 0.06]
    for p in round_bulbs:
        s.place("cornice bulb", (p[0], p[1], Z_FAR + 0.05 + p[2]), name="portal bulb")


# ---- lamps ---------------------------------------------------------------------------------------------------------
def lamps(s):
    s.mesh("festoon bulb", [(sphere(0.026, 8, 5), "festoon bulb"),
                            (lathe([(0.011, 0.020), (0.014, 0.024), (0.014, 0.055), (0, 0.06)], 6), "black steel")])
    s.mesh("cornice bulb", [(sphere(0.020, 6, 4), "cornice bulb")])
    # festoons from wall to wall at every pier but the ends, with less sag where they are far
    for i, z in enumerate(piers()[1:-1]):
        a, b, sag = np.array([-HALF + 0.12, 6.62, z]), np.array([HALF - 0.12, 6.62, z]), 1.02 + 0.05 * np.sin(2.3 * i)
        t = np.linspace(0, 1, 27)
        line = a + (b - a) * t[:, None]
        line[:, 1] -= sag * 4 * t * (1 - t)
        s.mesh(f"festoon {i}", [(furniture.tube(line + [0, 0.058, 0], 0.005, 4, 0.01, 1), "black steel")])
        s.place(f"festoon {i}")
        for p in line[1:-1]:
            s.place("festoon bulb", p)
    step = BAY / 10
    for x, _ in sides():
        for z in np.arange(Z_NEAR - step / 2, Z_FAR, -step):
            s.place("cornice bulb", (x * (HALF - 0.312), LEVEL + 0.29, z))
            s.place("cornice bulb", (x * (HALF - 0.292), 6.98 + 0.325, z))
    # ring chandeliers
    arms = [shops.ring(0.62, 0.020, 40, 6).moved(rotate("x", 90)), lathe([(0.0, -0.16), (0.07, -0.14), (0.09, 0.0), (0.05, 0.12), (0.02, 0.2), (0.014, 0.3), (0.009, 0.32), (0.009, 5.0)], 14)]
    globes = [sphere(0.15, 16, 9).moved(translate(0, -0.30, 0))]
    for k in range(8):
        m = rotate("y", 45.0 * k)
        arms.append(furniture.tube([(0.05, 0.1, 0), (0.3, 0.16, 0), (0.62, 0.0, 0)], 0.010, 6, 0.1, 3).moved(m))
        arms.append(lathe([(0, -0.03), (0.03, -0.02), (0.045, 0.03), (0.0, 0.035)], 10).moved(m @ translate(0.62, 0, 0)))
        globes.append(sphere(0.085, 12, 7).moved(m @ translate(0.62, 0.11, 0)))
    s.mesh("chandelier", [(join(arms), "brass"), (join(globes), "chandelier globe")])
    for i in (1, 3, 5, 7, 9):
        s.place("chandelier", (0, 4.55, bays()[i]))
    # twin globes on brackets
    arm, globe = [], []
    for k in (-1, 1):
        arm.append(furniture.tube([(0, 0, 0.10), (k * 0.07, -0.07, 0.24), (k * 0.20, -0.05, 0.32), (k * 0.20, 0.06, 0.32)], 0.012, 6, 0.06, 3))
        arm.append(lathe([(0, 0.05), (0.05, 0.055), (0.06, 0.075), (0, 0.08)], 12).moved(translate(k * 0.20, 0, 0.32)))
        globe.append(sphere(0.10, 14, 8).moved(translate(k * 0.20, 0.165, 0.32)))
    arm.append(lathe([(0.0, 0.0), (0.07, 0.0), (0.06, 0.02), (0.02, 0.03), (0.0, 0.03)], 14).moved(translate(0, -0.02, 0.10) @ rotate("x", 90)))
    s.mesh("bracket lamp", [(join(arm), "bronze"), (join(globe), "globe")])
    for x, yaw in sides():
        for i, z in enumerate(piers()[1:-1]):
            s.place("bracket lamp", (x * HALF, 2.95, z), yaw)
            # a spot on the cornice washes the wall above
            s.spot("wall washer", (x * (HALF - 0.24), FLOOR2 + 0.06, z), (x * 0.11, 1.0, 0), WARM, 2.2, 14, 48)


def fronts(s):
    rs = np.random.RandomState(31)
    for name, make in shops.KINDS.items():
        s.mesh(f"{name} goods", make(np.random.RandomState(sum(map(ord, name)))))
    tints = ("plum shop", "sage shop", "sand shop", "navy shop", "white shop")
    for tint in tints:
        s.mesh(tint, shops.shell(tint))
    s.mesh("front", shops.front(False)), s.mesh("front with door", shops.front(True))
    platform = [(box((-shops.WIDE, 0, -shops.DEEP), (shops.WIDE, shops.SILL, -0.10), "-y"), "dark wood")]
    inner = [(box((-0.36, 0, -shops.DEEP), (shops.WIDE, shops.SILL, -0.10), "-y"), "dark wood")]
    s.mesh("platform", platform), s.mesh("platform by the door", inner)
    s.mesh("fascia", shops.fascia())
    s.mesh("strip", [(box((-1.2, 2.42, -0.20), (1.2, 2.445, -0.165)), "strip"), (box((-1.22, 2.446, -0.21), (1.22, 2.50, -0.05)), "bronze")])
    wall_of = {"books": "plum shop", "ceramics": "white shop", "flowers": "sage shop", "clothes": "sand shop", "jewels": "navy shop",
               "lamps": "navy shop", "pastry": "sand shop", "wines": "plum shop"}
    light = {"books": WARM, "ceramics": WHITE, "flowers": (0.86, 1.0, 0.84), "clothes": SOFT, "jewels": WHITE, "lamps": AMBER,
             "pastry": WARM, "wines": AMBER}
    for (x, yaw), shopsides in zip(sides(), (RIGHT, LEFT)):
        for i, (kind, word, tube) in enumerate(shopsides):
            z = bays()[i]
            at = (on_wall(x), 0, z)
            m = translate(*at) @ rotate("y", yaw)
            door = i in DOORS
            s.place(wall_of[kind], at, yaw)
            s.place("front with door" if door else "front", at, yaw)
            s.place("platform by the door" if door else "platform", at, yaw)
            for part in (f"{kind} goods", "fascia", "strip"):
                s.place(part, at, yaw)
            for letter, along in shops.lettering(word, 0.33):
                name = f"{tube} {letter}"
                if name not in s.mesh_ids:
                    s.mesh(name, [(shops.glyph(letter, 0.33), f"{tube} tube")])
                s.place(name, (m @ [along, shops.TRANSOM + 0.14, 0.075, 1])[:3], yaw)
            # six spots of seven, ten or fourteen watts, as of metal halide lamps, under the ceiling, aimed at the goods
            for k in range(6):
                px = -1.15 + 0.46 * k
                p = m @ [px, shops.HIGH - 0.06, -0.45, 1]
                d = m @ [rs.uniform(-0.25, 0.25), -1.0, rs.uniform(-0.75, -0.25), 0]
                s.spot(f"{kind} spot", p[:3].round(4), d[:3].round(4), light[kind], float((12.0, 17.0, 24.0)[rs.randint(3)]), 12, 34)
    # rings of tube that stand out from the wall, with a disc between
    s.mesh("sign plate", [(lathe([(0, -0.012), (0.27, -0.012), (0.27, 0.012), (0, 0.012)], 32).moved(rotate("x", 90)), "fascia"),
                          (furniture.bar((0.0, 0.30, 0), (0.0, 0.55, 0), 0.012, 6), "iron"),
                          (furniture.bar((0.36, 0.55, 0), (-0.36, 0.55, 0), 0.016, 6), "iron")])
    marks = {"amber": "C", "rose": "M", "ice": "L", "green": "F", "red": "V"}
    for tube, letter in marks.items():
        sign = [shops.ring(0.29, 0.011, 30, 5)]
        glyph = shops.glyph(letter, 0.26).moved(translate(shops.lettering(letter, 0.26)[0][1], -0.13, 0.03))
        sign += [glyph, glyph.moved(rotate("y", 180))]
        s.mesh(f"{tube} ring", [(join(sign), f"{tube} tube")])
    order = list(marks)
    for side, (x, _) in enumerate(sides()):
        for i in range(1 + 2 * side, BAYS, 2):
            z = piers()[i + side]
            tube = order[(i // 2 + 2 * side) % 5]
            s.place("sign plate", (x * (HALF - 0.46), 3.62, z))
            s.place(f"{tube} ring", (x * (HALF - 0.46), 3.62, z))


# ---- on the pavement -----------------------------------------------------------------------------------------------
def furnish(s):
    rs = np.random.RandomState(8)
    tables = [furniture.round_table(0.33, 0.73)]
    s.mesh("cafe table", [(tables[0], "green marble"), (lathe([(0, 0.731), (0.03, 0.731), (0.034, 0.79), (0.028, 0.79), (0.026, 0.74), (0, 0.738)], 14), "cream")])
    s.mesh("candle", [(sphere(0.014, 8, 6).moved(np.diag([1, 2.0, 1, 1])), "candle")])
    s.mesh("chair", [(furniture.wooden_chair(), "dark wood")])
    pot, soil = furniture.pot(0.30, 0.52, 0.02)
    s.mesh("palm", [(pot, "terracotta"), (soil, "soil"), (furniture.plant(rs, 22, 1.15, 0.15, 0.75).moved(translate(0, 0.48, 0)), "leaves")])
    s.mesh("bench", [(ap.bench(1.6), "dark wood")])
    zs = bays()
    for x, z in ((-2.62, zs[2] + 0.75), (-2.55, zs[2] - 0.85), (-2.6, zs[6] + 0.8), (-2.66, zs[6] - 0.8), (2.6, zs[5] + 0.7), (2.58, zs[5] - 0.9)):
        s.place("cafe table", (x, 0, z), rs.uniform(0, 90))
        s.place("candle", (x, 0.785, z))
        for turn in (rs.uniform(-25, 25), 180 + rs.uniform(-25, 25)):
            d = np.array([np.sin(np.radians(turn)), np.cos(np.radians(turn))]) * 0.56
            s.place("chair", (x + d[0], -0.001, z + d[1]), 180 + turn)
    for x, i in ((1, 2), (1, 4), (-1, 4), (1, 7), (-1, 8), (-1, 1), (1, 9)):
        s.place("palm", (x * 3.10, -0.001, piers()[i]), rs.uniform(0, 360))
    for x, z in ((2.98, zs[3]), (-2.98, zs[7]), (2.98, zs[8])):
        s.place("bench", (x, -0.001, z), 90)


def main():
    s = Scene("arcade")
    materials(s)
    pavement(s)
    walls(s)
    vault(s)
    fronts(s)
    lamps(s)
    ends(s)
    furnish(s)
    s.camera("main", (-0.75, 1.62, 16.4), (0.20, 1.62, -10.0), yfov=55.0)
    s.camera("gallery", (0.0, 5.55, 17.9), (0.0, 5.55, -10.0), yfov=62.0)
    s.camera("window", (-1.75, 1.55, 11.7), (3.0, 1.55, 7.3), yfov=48.0)
    s.write("A covered street of shops at night, for light of many lamps: about a thousand, from bulbs of 0.2 W to spots of 14 W, in windows, "
            "lettering, festoons, chandeliers and lit rooms, most of them hidden from most places (cameras gallery: from above; window: close "
            "to the shops).", {"film.ev": 0.65})


if __name__ == "__main__":
    main()
