"""Shops of the arcade: fronts, goods in the windows, lettering of glass tubes. Parts are about the middle of a bay's
wall, x along the wall, +z towards the street; lists of (Mesh, material) that `Scene.mesh` takes."""
import numpy as np

import furniture
from gltf import join
from shapes import box, chamfer, disk, facing, grid, lathe, rotate, sphere, superquadric, translate

WIDE, DEEP, HIGH = 1.52, 2.1, 3.72       # half width, depth behind the wall's middle and height of a shop
SILL, TRANSOM = 0.46, 2.52               # platform of a window, lower edge of the sign
RADIUS = 1.30                            # of the arch, which springs at TRANSOM + 0.03

# Letters as strokes in a box 1 high; the tube rounds their corners.
LETTERS = {
    "A": (0.66, [[(0, 0), (0.33, 1), (0.66, 0)], [(0.13, 0.36), (0.53, 0.36)]]),
    "B": (0.56, [[(0, 0), (0, 1), (0.46, 1), (0.5, 0.54), (0.04, 0.53)], [(0.04, 0.52), (0.56, 0.5), (0.54, 0), (0, 0)]]),
    "C": (0.62, [[(0.62, 0.82), (0.48, 1), (0.1, 1), (0, 0.5), (0.1, 0), (0.48, 0), (0.62, 0.18)]]),
    "D": (0.60, [[(0, 0), (0, 1), (0.5, 1), (0.66, 0.5), (0.5, 0), (0, 0)]]),
    "E": (0.50, [[(0.5, 1), (0, 1), (0, 0), (0.5, 0)], [(0, 0.52), (0.42, 0.52)]]),
    "F": (0.48, [[(0.48, 1), (0, 1), (0, 0)], [(0, 0.52), (0.4, 0.52)]]),
    "G": (0.64, [[(0.6, 0.84), (0.48, 1), (0.1, 1), (0, 0.5), (0.1, 0), (0.52, 0), (0.64, 0.3), (0.62, 0.46), (0.38, 0.46)]]),
    "I": (0.04, [[(0.02, 0), (0.02, 1)]]),
    "L": (0.48, [[(0, 1), (0, 0), (0.48, 0)]]),
    "M": (0.76, [[(0, 0), (0.06, 1), (0.38, 0.3), (0.70, 1), (0.76, 0)]]),
    "N": (0.60, [[(0, 0), (0, 1), (0.6, 0), (0.6, 1)]]),
    "O": (0.70, [[(0.35, 1), (0.64, 0.96), (0.7, 0.5), (0.64, 0.04), (0.06, 0.04), (0, 0.5), (0.06, 0.96), (0.35, 1)]]),
    "P": (0.54, [[(0, 0), (0, 1), (0.5, 1), (0.54, 0.5), (0.02, 0.48)]]),
    "R": (0.56, [[(0, 0), (0, 1), (0.5, 1), (0.54, 0.5), (0.02, 0.48)], [(0.26, 0.48), (0.56, 0)]]),
    "S": (0.54, [[(0.52, 0.84), (0.42, 1), (0.08, 1), (0.04, 0.6), (0.5, 0.46), (0.5, 0), (0.1, 0), (0, 0.16)]]),
    "T": (0.60, [[(0, 1), (0.6, 1)], [(0.3, 1), (0.3, 0)]]),
    "U": (0.60, [[(0, 1), (0.02, 0.02), (0.58, 0.02), (0.6, 1)]]),
    "V": (0.62, [[(0, 1), (0.31, 0), (0.62, 1)]]),
}


GLYPHS = {}


def glyph(letter, height, radius=0.0095):
    """A letter of glass tubes, its foot's left end at the origin; made once, so that all of one size share their bytes."""
    if (letter, height) not in GLYPHS:
        GLYPHS[letter, height] = join([furniture.tube([(u * height, v * height, 0) for u, v in stroke], radius, 5, 0.12 * height, 3)
                                       for stroke in LETTERS[letter][1]])
    return GLYPHS[letter, height]


def lettering(word, height, gap=0.22):
    """(letter, x) of a word that is centred about x = 0."""
    x = -(sum(LETTERS[c][0] for c in word) + gap * (len(word) - 1)) / 2
    places = []
    for c in word:
        places.append((c, x * height))
        x += LETTERS[c][0] + gap
    return places


def ring(radius, thick, segments=28, sides=6):
    """A ring of tube in the x-y plane."""
    a = 2 * np.pi * np.arange(sides + 1) / sides
    return lathe([(radius + thick * np.cos(v), thick * np.sin(v)) for v in a], segments, smooth=80).moved(rotate("x", 90))


def shell(wall, floor_at=0.0):
    """Walls, floor and ceiling of a shop, closed except towards the street; they overlap the street's wall."""
    w, d, h, t = WIDE, DEEP, HIGH, 0.08
    return [(join([box((-w - t, -0.3, -d - t), (w + t, h + t, -d), "-z"),
                   box((-w - t, -0.3, -d - t), (-w, h + t, -0.10), "-x"),
                   box((w, -0.3, -d - t), (w + t, h + t, -0.10), "+x"),
                   box((-w - t, h, -d - t), (w + t, h + t, -0.10), "+y")]), wall),
            (box((-w - t, -0.3, -d - t), (w + t, floor_at + 0.002, -0.12)), "shop floor")]


def front(door):
    """Bronze frame in the arch and, where there is no door, a stall riser of marble. `door`: the left third is open down to
    the pavement."""
    r, spring, z0, z1 = RADIUS, TRANSOM + 0.03, -0.06, 0.02
    bars = [chamfer((-r - 0.01, SILL - 0.02 if not door else -0.002, z0), (-r + 0.055, spring + 0.02, z1), 0.006),
            chamfer((r - 0.055, SILL - 0.02, z0), (r + 0.01, spring + 0.02, z1), 0.006)]
    posts = (-0.42, 0.42) if not door else (-0.36, 0.46)
    for x in posts:
        foot = -0.002 if door and x < 0 else SILL - 0.02
        bars.append(chamfer((x - 0.026, foot, z0 + 0.006), (x + 0.026, TRANSOM + 0.01, z1 - 0.006), 0.005))
    bars.append(chamfer((-r + 0.02, TRANSOM - 0.03, z0 - 0.01), (r - 0.02, TRANSOM + 0.035, z1 + 0.015), 0.008))
    left = -0.36 if door else -r + 0.04
    bars.append(chamfer((left, SILL - 0.03, z0 - 0.006), (r - 0.04, SILL + 0.045, z1 + 0.012), 0.006))
    # the fan above the sign: an inner arc and spokes
    for k in range(7):
        a = np.radians(30 + 20 * k)
        c = np.array([np.cos(a), np.sin(a)])
        bars.append(furniture.bar((0.70 * c[0], spring + 0.70 * c[1], -0.02), (r * c[0], spring + r * c[1], -0.02), 0.011, 6))
    arc = [(0.70 * np.cos(a), spring + 0.70 * np.sin(a), -0.02) for a in np.radians(np.linspace(22, 158, 13))]
    bars.append(furniture.tube(arc, 0.013, 6, 0.03, 1))
    riser = [chamfer((left, -0.002, -0.12), (r + 0.005, SILL, 0.03), 0.01)]
    for x0, x1 in ((left + 0.06, -0.44), (-0.40, 0.40), (0.44, r - 0.06)):
        if x1 - x0 > 0.2:
            riser.append(chamfer((x0, 0.10, 0.02), (x1, SILL - 0.07, 0.044), 0.012))
    return [(join(bars), "bronze"), (join(riser), "green marble")]


def fascia():
    return [(chamfer((-1.10, TRANSOM + 0.05, 0.0), (1.10, TRANSOM + 0.56, 0.045), 0.012), "fascia"),
            (join([chamfer((-1.13, TRANSOM + y, -0.01), (1.13, TRANSOM + y + 0.03, 0.075), 0.008) for y in (0.035, 0.55)]),
             "brass")]


# ---- what is for sale: lists of parts on the platform, front at z about -0.3, back wall at -DEEP --------------------
def shelves(count, y0=0.9, step=0.62, deep=0.34, wide=1.36):
    return join([chamfer((-wide, y0 + step * k, -DEEP - 0.002), (wide, y0 + step * k + 0.028, -DEEP + deep), 0.004)
                 for k in range(count)])


def books(rs):
    case, levels = furniture.bookcase(2.8, 2.5, 0.30, 6)
    parts = [(case.moved(translate(0, SILL, -DEEP)), "dark wood")]
    tones = ("red cloth", "blue cloth", "green cloth", "cream", "ochre")
    stacks = {tone: [] for tone in tones}
    for y in levels:
        x = -1.34
        while x < 1.30:
            wide, high, deep = rs.uniform(0.018, 0.055), rs.uniform(0.23, 0.33), rs.uniform(0.17, 0.22)
            gap = rs.uniform(0.1, 0.3) if rs.uniform() < 0.04 else 0.0
            front = -DEEP + 0.27 - rs.uniform(0, 0.02)
            stacks[tones[rs.randint(5)]].append(box((x, y + SILL - 0.001, front - deep), (x + wide, y + SILL + high, front), "-y -z"))
            x += wide + 0.001 + gap
    for k, x in enumerate((-0.95, -0.5, 0.1, 0.6, 1.05)):
        y = SILL
        for _ in range(rs.randint(2, 6)):
            high, half = rs.uniform(0.025, 0.05), rs.uniform(0.09, 0.13, 2)
            m = translate(x, y, -0.55 - 0.3 * (k % 2)) @ rotate("y", rs.uniform(-30, 30))
            stacks[tones[rs.randint(5)]].append(chamfer((-half[0], 0, -half[1]), (half[0], high, half[1]), 0.004).moved(m))
            y += high + 0.0004
    return parts + [(join(v), k) for k, v in stacks.items()]


def turned(profile, segments=20):
    return lathe(profile, segments, smooth=50)


def ceramics(rs):
    parts = {"dark wood": [shelves(4)], "celadon": [], "cobalt": [], "cream": [], "oxblood": []}
    glazes = ("celadon", "cobalt", "cream", "oxblood")
    vase = [(0, 0), (0.05, 0), (0.085, 0.09), (0.08, 0.16), (0.035, 0.23), (0.045, 0.27), (0.0, 0.262)]
    jar = [(0, 0), (0.06, 0), (0.10, 0.07), (0.10, 0.13), (0.06, 0.18), (0.065, 0.195), (0.02, 0.215), (0.018, 0.235), (0, 0.24)]
    dish = [(0, 0.004), (0.04, 0), (0.05, 0.01), (0.13, 0.055), (0.128, 0.06), (0.045, 0.02), (0, 0.016)]
    for level in range(4):
        for x in np.arange(-1.2, 1.25, 0.3):
            kind = (vase, jar, dish)[rs.randint(3)]
            m = translate(x + rs.uniform(-0.04, 0.04), 0.928 + 0.62 * level, -DEEP + 0.17) @ np.diag(
                [*([rs.uniform(0.85, 1.25)] * 3), 1])
            parts[glazes[rs.randint(4)]].append(turned(kind, 14).moved(m))
    for x, z, k in ((-0.9, -0.7, 2.2), (-0.25, -0.95, 2.9), (0.5, -0.65, 1.8), (1.0, -1.0, 2.5)):
        parts[glazes[rs.randint(4)]].append(turned((vase, jar)[rs.randint(2)], 28).moved(
            translate(x, SILL, z) @ np.diag([k, k, k, 1])))
    return [(join(v), k) for k, v in parts.items() if v]


def flowers(rs):
    pots, soil, leaves, blooms = [], [], [], {"rose petals": [], "yellow petals": [], "white petals": []}
    for k, (x, z, lift) in enumerate([(-1.1, -0.5, 0), (-0.6, -0.8, 0.25), (-0.1, -0.5, 0), (0.4, -0.9, 0.3), (0.9, -0.5, 0),
                                      (-0.9, -1.4, 0.6), (-0.2, -1.5, 0.85), (0.6, -1.45, 0.65), (1.2, -1.3, 0.5)]):
        r = rs.uniform(0.11, 0.17)
        body, earth = furniture.pot(r, 1.7 * r)
        m = translate(x, SILL + lift, z)
        if lift:
            pots.append(chamfer((x - 0.2, SILL - 0.002, z - 0.2), (x + 0.2, SILL + lift, z + 0.2), 0.01))
        pots.append(body.moved(m)), soil.append(earth.moved(m))
        leaves.append(furniture.plant(rs, 8, rs.uniform(0.42, 0.65), 0.10, 0.8).moved(m @ translate(0, 1.6 * r, 0)))
        kind = list(blooms)[k % 3]
        for _ in range(7):
            a, d = rs.uniform(0, 2 * np.pi), rs.uniform(0.03, 0.2)
            blooms[kind].append(superquadric((0.035, 0.026, 0.035), 1, 1, 7, 4).moved(
                m @ translate(d * np.cos(a), 1.6 * r + rs.uniform(0.28, 0.5), d * np.sin(a))))
    return [(join(pots), "terracotta"), (join(soil), "soil"), (join(leaves), "leaves")] + [
        (join(v), k) for k, v in blooms.items()]


def mannequin():
    """A dressmaker's bust on a stand with a long dress, about 1.75 m tall."""
    dress = turned([(0.40, 0.12), (0.34, 0.35), (0.25, 0.72), (0.16, 1.02), (0.125, 1.10), (0.15, 1.22), (0.185, 1.36),
                    (0.175, 1.46), (0.10, 1.54), (0.05, 1.56), (0.0, 1.555)], 28)
    folds = dress.p.copy()
    a = np.arctan2(folds[:, 2], folds[:, 0])
    folds[:, [0, 2]] *= (1 + 0.07 * np.clip(1.05 - folds[:, 1], 0, 1) * np.cos(9 * a))[:, None]
    folds[:, 2] *= 0.8
    dress.p[:] = folds
    stand = turned([(0, 0), (0.2, 0), (0.2, 0.015), (0.02, 0.03), (0.016, 0.2), (0, 0.2)], 20)
    neck = turned([(0.05, 1.55), (0.046, 1.62), (0.06, 1.645), (0.03, 1.67), (0.0, 1.70)], 16)
    return dress, join([stand, neck])


def clothes(rs, colours=("rose silk", "saffron cloth", "blue cloth")):
    parts = []
    dress, wood = mannequin()
    for k, (x, z) in enumerate(((-0.8, -0.75), (0.05, -0.95), (0.85, -0.7))):
        m = translate(x, SILL, z) @ rotate("y", (20, -10, -25)[k])
        parts += [(dress.moved(m), colours[k]), (wood.moved(m), "brass")]
    import atrium_parts
    for k, x in enumerate((-0.98, -0.33, 0.33, 0.98)):
        parts.append((atrium_parts.hanging(0.6, 2.5, 3 + k, 4.0, 0.04, 16, 8).moved(translate(x, 3.35, -DEEP + 0.12)),
                      ("velvet", "blue cloth", "velvet", "saffron cloth")[k]))
    return parts


def jewels(rs):
    stands, gold, velvet = [], [], [chamfer((-1.4, SILL - 0.002, -1.5), (1.4, SILL + 0.10, -0.3), 0.02)]
    for row, (z, y) in enumerate(((-0.5, 0.12), (-0.85, 0.32), (-1.2, 0.55))):
        velvet.append(chamfer((-1.35, SILL + 0.09, z - 0.16), (1.35, SILL + y, z + 0.16), 0.015))
        for x in np.arange(-1.2 + 0.1 * row, 1.25, 0.27):
            stands.append(turned([(0, 0), (0.05, 0), (0.05, 0.01), (0.02, 0.03), (0.03, 0.12), (0, 0.125)], 12).moved(
                translate(x, SILL + y - 0.001, z)))
            if rs.uniform() < 0.6:
                gold.append(ring(0.05, 0.008, 16, 5).moved(translate(x, SILL + y + 0.175, z) @ rotate("y", rs.uniform(-50, 50))))
            else:
                gold.append(turned([(0, 0), (0.03, 0), (0.055, 0.05), (0.06, 0.075), (0.054, 0.073), (0.02, 0.012), (0, 0.01)],
                                   14).moved(translate(x, SILL + y + 0.12, z)))
    back = chamfer((-1.35, 0.9, -DEEP - 0.002), (1.35, 3.3, -DEEP + 0.03), 0.01)
    return [(join(velvet), "velvet"), (join(stands), "cream"), (join(gold), "gold"), (back, "velvet")]


LAMPS = [(-1.1, 2.1, -0.8, 0.11), (-0.75, 2.5, -1.3, 0.15), (-0.35, 1.9, -0.7, 0.09), (-0.05, 2.35, -1.1, 0.17),
         (0.35, 2.0, -0.8, 0.12), (0.7, 2.5, -1.35, 0.13), (1.0, 2.1, -0.75, 0.10), (1.15, 1.7, -1.4, 0.14),
         (-1.15, 1.55, -1.45, 0.16), (0.15, 1.6, -1.5, 0.10), (-0.55, 1.45, -1.6, 0.12), (0.65, 1.5, -1.6, 0.11)]


def lamps(rs):
    """A shop of lamps: globes of opal in three colours on cords, and the shelf below them."""
    parts = {"opal": [], "amber opal": [], "rose opal": []}
    cords = []
    for k, (x, y, z, r) in enumerate(LAMPS):
        parts[list(parts)[k % 3]].append(sphere(r, 12, 7).moved(translate(x, y, z)))
        cords.append(turned([(0.0, 0), (0.4 * r, 0.0), (0.3 * r, 0.35 * r), (0.006, 0.5 * r), (0.006, HIGH - y - 0.9 * r)], 8).moved(
            translate(x, y + 0.92 * r, z)))
    low = chamfer((-1.2, SILL - 0.002, -1.7), (1.2, SILL + 0.42, -0.6), 0.015)
    return [(join(v), k) for k, v in parts.items()] + [(join(cords), "brass"), (low, "dark wood")]


def pastry(rs):
    parts = {"dark wood": [shelves(4, 0.95, 0.56, 0.36)], "crust": [], "cream": [], "brass": [], "rose petals": []}
    for level in range(4):
        for x in np.arange(-1.22, 1.25, 0.20):
            kind = rs.randint(3)
            m = translate(x, 0.978 + 0.56 * level, -DEEP + 0.19)
            if kind == 0:
                parts["crust"].append(superquadric((0.085, 0.055, 0.14), 1, 1, 10, 6).moved(m @ translate(0, 0.05, 0)))
            elif kind == 1:
                parts["crust"].append(superquadric((0.08, 0.045, 0.08), 1, 0.8, 10, 6).moved(m @ translate(0, 0.04, 0)))
            else:
                parts["cream"].append(turned([(0, 0), (0.075, 0), (0.08, 0.06), (0.05, 0.10), (0.0, 0.13)], 10).moved(m))
    for x, z, tiers in ((-0.85, -0.7, 3), (0.0, -0.9, 4), (0.85, -0.65, 3)):
        y = SILL
        for t in range(tiers):
            r = 0.24 - 0.05 * t
            parts["brass"].append(turned([(0, 0), (0.02, 0), (0.02, 0.16), (r + 0.04, 0.17), (r + 0.045, 0.18), (0, 0.182)], 24).moved(
                translate(x, y, z)))
            parts["cream" if t % 2 else "rose petals"].append(
                turned([(0, 0.182), (r, 0.182), (r + 0.005, 0.27), (r - 0.03, 0.285), (0, 0.285)], 24).moved(translate(x, y, z)))
            y += 0.285
    return [(join(v), k) for k, v in parts.items() if v]


def wines(rs):
    bottle = turned([(0.04, 0), (0.04, 0.19), (0.015, 0.25), (0.015, 0.32), (0, 0.32)], 8)
    parts = {"dark wood": [shelves(5, 0.75, 0.5, 0.3)], "bottle green": [], "bottle red": [], "ochre": []}
    for level in range(5):
        for x in np.arange(-1.28, 1.3, 0.14):
            if rs.uniform() < 0.88:
                parts["bottle green" if rs.uniform() < 0.65 else "bottle red"].append(
                    bottle.moved(translate(x, 0.777 + 0.5 * level, -DEEP + 0.15)))
    barrel = [(0, 0), (0.24, 0), (0.27, 0.12), (0.30, 0.36), (0.27, 0.60), (0.24, 0.72), (0.225, 0.72), (0.225, 0.70), (0, 0.70)]
    for x, z in ((-0.9, -0.75), (0.85, -0.8)):
        parts["dark wood"].append(turned(barrel, 24).moved(translate(x, SILL, z)))
        for dx, dz in ((-0.1, 0.05), (0.08, -0.06), (0.03, 0.11)):
            parts["bottle green"].append(bottle.moved(translate(x + dx, SILL + 0.70, z + dz)))
    for x in (-0.25, 0.05, 0.35):
        parts["ochre"].append(chamfer((x - 0.13, SILL - 0.002, -0.95), (x + 0.13, SILL + 0.22, -0.55), 0.008))
    return [(join(v), k) for k, v in parts.items() if v]


KINDS = {"books": books, "ceramics": ceramics, "flowers": flowers, "clothes": clothes, "jewels": jewels, "lamps": lamps,
         "pastry": pastry, "wines": wines}
