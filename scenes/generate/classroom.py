"""A classroom on a bright morning (`classroom`): twenty desks and chairs on thin legs, and hundreds of small things.

x to the right, y up; the blackboard is on the wall at z = -4.4, windows to the left. Sun and sky come through three tall
windows, six panels shine in the ceiling. Occlusion changes everywhere within centimetres, under desks and behind chair
legs: the hard case for a cache of irradiance.
"""
import os

import numpy as np

import furniture as f
import rooms
from gltf import Scene, hdr, join
from shapes import box, chamfer, lathe, quad, rotate, sphere, sweep, translate

WIDTH, DEPTH, HEIGHT = 7.6, 8.8, 3.25
WINDOWS = [(-3.35, -1.25), (-0.85, 1.25), (1.65, 3.75)]    # z from, to, of the openings in the left wall
SILL, HEAD = 0.92, 2.85
DOOR = (2.05, 3.00, 2.10)                                  # z from, to, and height, in the right wall
PANELS = [(x, z) for z in (-2.7, 0.0, 2.7) for x in (-1.75, 1.75)]
PANEL = (0.62, 1.24)
SUN = np.array([1.0, -0.78, -0.34])                        # the way it shines
COLUMNS, ROWS = (-2.55, -0.95, 0.65, 2.25), (-1.75, -0.55, 0.65, 1.85, 3.05)


def sky(width=128):
    """A bright hazy sky over trees and pale ground, (h, w, 3) radiance; no sun in it."""
    h = width // 2
    v, u = (np.arange(h) + 0.5) / h, (np.arange(width) + 0.5) / width
    up = np.repeat(np.cos(np.pi * v)[:, None], width, 1)
    phi = 2 * np.pi * u[None, :]
    t = np.clip(up, 0, 1)[..., None] ** 0.55
    colour = np.array([1.02, 1.10, 1.18]) * (1 - t) + np.array([0.42, 0.66, 1.12]) * t
    trees = 0.10 + 0.05 * np.sin(5 * phi + 1) + 0.035 * np.sin(11 * phi) + 0.03 * np.sin(23 * phi + 2)
    shade = np.clip((trees - up) / 0.03, 0, 1)[..., None]
    colour = colour * (1 - shade) + shade * np.array([0.10, 0.155, 0.07]) * (1 + 0.25 * np.sin(31 * phi))[..., None]
    ground = np.clip((-0.06 - up) / 0.04, 0, 1)[..., None]
    return colour * (1 - ground) + ground * np.array([0.27, 0.265, 0.22])


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    matt("wall", 0.70, 0.69, 0.63)
    matt("lower wall", 0.42, 0.54, 0.50)
    matt("ceiling", 0.78, 0.78, 0.77)
    matt("white wood", 0.74, 0.735, 0.72)
    for k, c in enumerate(((0.45, 0.30, 0.17), (0.41, 0.27, 0.15), (0.48, 0.33, 0.195), (0.43, 0.285, 0.16))):
        matt(f"boards {k}", *c)
    matt("dark", 0.05, 0.045, 0.04)
    matt("beech", 0.58, 0.42, 0.255)
    matt("oak", 0.36, 0.22, 0.12)
    s.material("steel", (0.17, 0.19, 0.21), rough=0.45)
    matt("board", 0.055, 0.105, 0.085)
    matt("chalk", 0.72, 0.72, 0.69)
    matt("paper", 0.74, 0.73, 0.69)
    matt("red", 0.55, 0.075, 0.05)
    matt("blue", 0.07, 0.17, 0.42)
    matt("green", 0.10, 0.34, 0.13)
    matt("yellow", 0.76, 0.52, 0.06)
    matt("teal", 0.07, 0.34, 0.36)
    matt("black", 0.035, 0.035, 0.04)
    matt("terracotta", 0.52, 0.25, 0.14)
    matt("soil", 0.08, 0.055, 0.04)
    matt("leaf", 0.13, 0.28, 0.07, double=True)
    matt("cork", 0.44, 0.285, 0.16)
    s.material("globe", (0.10, 0.27, 0.46), rough=0.3)
    s.material("panel", (0.6, 0.6, 0.6), lambert=True, emit=(1.0, 0.95, 0.87), strength=4.5)


def architecture(s):
    w, d = WIDTH / 2, DEPTH / 2
    holes = {"-x": [(a, b, SILL, HEAD) for a, b in WINDOWS], "+x": [(DOOR[0], DOOR[1], -0.2, DOOR[2])],
             "ceiling": [(x - PANEL[0] / 2, x + PANEL[0] / 2, z - PANEL[1] / 2, z + PANEL[1] / 2) for x, z in PANELS]}
    sh = rooms.shell(WIDTH, DEPTH, HEIGHT, 0.36, holes)
    s.mesh("walls", [(join([sh[k] for k in ("-x", "+x", "-z", "+z")]), "wall")])
    s.mesh("ceiling", [(sh["ceiling"], "ceiling")])
    s.mesh("subfloor", [(sh["floor"], "dark")])
    s.mesh("boards", [(m, f"boards {k}") for k, m in enumerate(rooms.planks(WIDTH - 0.006, DEPTH - 0.006, 0.19, 2.9))])
    s.place("walls")
    s.place("ceiling")
    for name in ("subfloor", "boards"):
        s.place(name, (0, -0.02, 0))
    # lamps: an emissive face 3 cm up in each hole, closed above, a frame below
    x, z = PANEL[0] / 2, PANEL[1] / 2
    face = quad((-x, 0, -z), (x, 0, -z), (x, 0, z), (-x, 0, z))
    case = box((-x - 0.05, 0.001, -z - 0.05), (x + 0.05, 0.10, z + 0.05), "-y")
    frame = [chamfer((k * (x - 0.004), -0.036, -z - 0.03), (k * (x + 0.03), -0.024, z + 0.03), 0.003) for k in (-1, 1)]
    frame += [chamfer((-x - 0.029, -0.0355, k * (z - 0.0045)), (x + 0.029, -0.0245, k * (z + 0.0293)),
                      0.003) for k in (-1, 1)]
    louvres = [box((-x, -0.026, t - 0.004), (x, -0.004, t + 0.004), "-x +x") for t in np.linspace(-z, z, 9)[1:-1]]
    s.mesh("ceiling lamp", [(face, "panel"), (join([case] + frame + louvres), "white wood")])
    for px, pz in PANELS:
        s.place("ceiling lamp", (px, HEIGHT + 0.03, pz))
    # windows, sills, radiators under them
    a, b = WINDOWS[0]
    frame = rooms.window(b - a, HEAD - SILL, 3, 2, 0.06, 0.045, 0.07)
    sill = chamfer((-0.06, -0.035, -0.05), (b - a + 0.06, 0.004, 0.40), 0.008)
    s.mesh("window", [(join([frame, sill]), "white wood")])
    s.mesh("radiator", [(rooms.radiator(1.5, 0.58), "white wood")])
    for a, b in WINDOWS:
        s.place("window", (-w - 0.28, SILL, b), 90)
        s.place("radiator", (-w + 0.012, 0, (a + b) / 2), 90)
    leaf, knobs = rooms.door(DOOR[1] - DOOR[0] - 0.03, DOOR[2] - 0.02)
    back = box((-0.1, -0.1, -0.40), (DOOR[1] - DOOR[0] + 0.1, DOOR[2] + 0.1, -0.30))
    s.mesh("door", [(join([leaf.moved(translate(0.015, 0.004, -0.06)), back,
                           rooms.architrave(DOOR[1] - DOOR[0], DOOR[2], 0.09, 0.024)]), "white wood"),
                    (knobs.moved(translate(0.015, 0, -0.06)), "steel")])
    s.place("door", (w, 0, DOOR[0]), -90)
    # painted lower walls with a rail
    def lower(length):
        return [(box((-length / 2, -0.002, -0.004), (length / 2, 0.82, 0.006), "-x +x -z"), "lower wall"),
                (join([chamfer((-length / 2 + 0.001, 0.815, -0.004), (length / 2 - 0.001, 0.875, 0.020), 0.005),
                       chamfer((-length / 2 + 0.001, -0.002, -0.004), (length / 2 - 0.001, 0.12, 0.018), 0.005)]),
                 "white wood")]
    for name, length, at, yaw in (("lower far", WIDTH - 0.05, (0, 0, -d), 0),
                                  ("lower near", WIDTH - 0.05, (0, 0, d), 180),
                                  ("lower left", DEPTH, (-w, 0, 0), 90)):
        s.mesh(name, lower(length))
        s.place(name, at, yaw)
    for k, (a, b) in enumerate(((-d, DOOR[0] - 0.09), (DOOR[1] + 0.09, d))):
        s.mesh(f"lower right {k}", lower(b - a))
        s.place(f"lower right {k}", (w, 0, (a + b) / 2), -90)


def desk():
    """(wood, steel) of a pupil's desk, 0.70 x 0.50 m, the pupil at +z; a shelf under the top, bent steel legs."""
    wood = [chamfer((-0.35, 0.715, -0.25), (0.35, 0.740, 0.25), 0.006),
            chamfer((-0.31, 0.585, -0.205), (0.31, 0.597, 0.18), 0.003),
            chamfer((-0.312, 0.59, -0.212), (0.312, 0.70, -0.200), 0.003)]
    steel = []
    for x in (-0.315, 0.315):
        steel.append(f.tube([(x, 0.011, 0.235), (x, 0.011, -0.235)], 0.0115, 8))
        steel.append(f.tube([(x, 0.011, -0.03), (x, 0.705, -0.03)], 0.0125, 8))
        steel.append(f.tube([(x, 0.705, -0.215), (x, 0.705, 0.215)], 0.0095, 8))
        steel.append(f.tube([(x * 0.985, 0.60, -0.20), (x * 0.985, 0.60, 0.18)], 0.006, 6))
        steel += [chamfer((x - 0.015, -0.001, z - 0.02), (x + 0.015, 0.014, z + 0.02), 0.003) for z in (-0.235, 0.235)]
    steel.append(f.bar((-0.315, 0.16, -0.03), (0.315, 0.16, -0.03), 0.0095, 8))
    return join(wood), join(steel)


def chair():
    """(wood, steel) of a pupil's chair facing -z: bent tube, a curved seat and back."""
    x = np.linspace(-0.19, 0.19, 9)
    frames = (np.tile([0.0, 1, 0], (9, 1)), np.tile([0.0, 0, 1], (9, 1)))
    path = np.stack([x, np.full_like(x, 0.73), 0.215 + 0.018 * (1 - (x / 0.19) ** 2)], 1)
    h, t = 0.075, 0.005
    back = sweep([(-h, -t), (-h, t), (-h + 0.008, t + 0.001), (h - 0.008, t + 0.001), (h, t), (h, -t),
                  (-h, -t)], path, frames,
                 smooth=20)
    ends = [chamfer((k * 0.186, 0.656, 0.209), (k * 0.1925, 0.804, 0.2215), 0.003) for k in (-1, 1)]
    seat = chamfer((-0.195, 0.437, -0.19), (0.195, 0.450, 0.18), 0.0055)
    steel = []
    for k in (-1, 1):
        a = k * 0.175
        steel.append(f.tube([(k * 0.19, 0.0, -0.205), (a, 0.425, -0.155), (a, 0.425, 0.16),
                             (a, 0.80, 0.204)], 0.0105, 8,
                            0.05))
        steel.append(f.tube([(a, 0.42, 0.06), (k * 0.19, 0.0, 0.235)], 0.0105, 8))
        steel += [lathe([(0, -0.001), (0.015, -0.001), (0.014, 0.02), (0, 0.022)], 10).moved(translate(k * 0.19, 0, z))
                  for z in (-0.205, 0.235)]
    steel.append(f.bar((-0.175, 0.428, -0.10), (0.175, 0.428, -0.10), 0.008))
    steel.append(f.bar((-0.175, 0.428, 0.10), (0.175, 0.428, 0.10), 0.008))
    return join([back, seat] + ends), join(steel)


def pupils(s):
    rs = np.random.RandomState(12)
    for name, (wood, steel) in (("desk", desk()), ("chair", chair())):
        s.mesh(name, [(wood, "beech"), (steel, "steel")])
    tones = ("red", "blue", "green", "yellow", "teal")
    shut, pages = f.flat_book(0.155, 0.022, 0.215)
    leaves = join([chamfer((k * 0.002, 0.001, -0.105), (k * 0.15, 0.012, 0.105), 0.004) for k in (-1, 1)])
    cover = chamfer((-0.156, 0, -0.109), (0.156, 0.0025, 0.109), 0.001)
    body, tip = f.pencil()
    sharpener = chamfer((-0.012, 0, -0.008), (0.012, 0.014, 0.008), 0.002)
    box_ = join([chamfer((-0.105, 0, -0.035), (0.105, 0.030, 0.035), 0.006),
                 chamfer((-0.107, 0.024, -0.037), (0.107, 0.040, 0.037), 0.006)])
    bag = join([chamfer((-0.17, -0.001, -0.07), (0.17, 0.36, 0.07), 0.035),
                chamfer((-0.13, 0.03, 0.05), (0.13, 0.20, 0.11), 0.025),
                f.tube([(-0.05, 0.35, 0), (-0.05, 0.41, 0), (0.05, 0.41, 0), (0.05, 0.35, 0)], 0.007, 6, 0.03)])
    sheet = box((-0.105, 0, -0.1485), (0.105, 0.0012, 0.1485))
    s.mesh("sheet", [(sheet, "paper")])
    for t in tones:
        s.mesh(f"{t} book", [(shut, t), (pages, "paper")])
        s.mesh(f"{t} open book", [(cover, t), (leaves, "paper")])
        s.mesh(f"{t} pencil", [(body, t), (tip, "beech")])
        s.mesh(f"{t} case", [(box_, t)])
        s.mesh(f"{t} bag", [(bag, t)])
        s.mesh(f"{t} sharpener", [(sharpener, t)])
    top = 0.7392
    for i, z in enumerate(ROWS):
        for j, x in enumerate(COLUMNS):
            x += rs.uniform(-0.025, 0.025)
            z_ = z + rs.uniform(-0.03, 0.03)
            turn = rs.uniform(-2.5, 2.5)
            s.place("desk", (x, 0, z_), turn)
            s.place("chair", (x + rs.uniform(-0.05, 0.05), 0, z_ + rs.uniform(0.33, 0.50)), turn + rs.uniform(-14, 14))
            pick = lambda: tones[rs.randint(len(tones))]
            at = lambda dx, dz: (x + dx, top, z_ + dz)
            if rs.uniform() < 0.55:
                s.place(f"{pick()} open book", at(rs.uniform(-0.12, 0.02), 0.06), rs.uniform(-12, 12))
            else:
                s.place("sheet", at(-0.02, 0.06), rs.uniform(-15, 15))
                if rs.uniform() < 0.6:
                    s.place("sheet", (x - 0.05, top + 0.0014, z_ + 0.05), rs.uniform(-30, 30))
            n = rs.randint(0, 4)
            for k in range(n):
                s.place(f"{pick()} book", (x + 0.235 + rs.uniform(-0.012, 0.012), top + 0.0222 * k, z_ - 0.10),
                        rs.uniform(-14, 14))
            for k in range(rs.randint(1, 4)):
                s.place(f"{pick()} pencil", at(rs.uniform(-0.22, 0.10), -0.09 - 0.035 * k), rs.uniform(-20, 20))
            if rs.uniform() < 0.45:
                s.place(f"{pick()} case", at(-0.22, -0.19), rs.uniform(-8, 8))
            if rs.uniform() < 0.5:
                s.place(f"{pick()} sharpener", at(0.06, -0.20), rs.uniform(0, 90))
            if rs.uniform() < 0.65:
                s.place(f"{pick()} book", (x - 0.12, 0.5965, z_), rs.uniform(-6, 6))
            if rs.uniform() < 0.4 and i < 3:
                s.place(f"{pick()} bag", (x + 0.52 * (1 if j < 3 else -1) * 0.98, 0, z_ + 0.05),
                        90 + rs.uniform(-15, 15))


def front(s):
    """Blackboard, the teacher's desk, pin board, clock, globe."""
    d = DEPTH / 2
    rs = np.random.RandomState(3)
    board = box((-1.75, 0.98, -0.004), (1.75, 2.22, 0.022), "-z")
    rim = [chamfer((-1.802, y, -0.004), (1.802, y + 0.05, 0.034), 0.004) for y in (0.93, 2.22)]
    rim += [chamfer((k * 1.75, 0.931, -0.003), (k * 1.80, 2.269, 0.033), 0.004) for k in (-1, 1)]
    tray = chamfer((-1.5, 0.915, 0.02), (1.5, 0.935, 0.10), 0.004)
    chalk = []
    for k in range(6):   # lines of writing: short strokes
        y, x = 2.06 - 0.145 * k, -1.55
        while x < 0.25 - 0.3 * (k % 2):
            n = rs.uniform(0.05, 0.16)
            chalk.append(box((x, y + rs.uniform(-0.008, 0.008), 0.021),
                             (x + n, y + rs.uniform(0.014, 0.03), 0.0228), "-z"))
            x += n + 0.035
    ring = lathe([(0.27, 0.0), (0.285, 0.0), (0.285, 0.0018), (0.27, 0.0018), (0.27, 0)], 40).moved(
        translate(1.05, 1.62, 0.0212) @ rotate("x", 90))
    line = [f.bar((1.05 + a, 1.62 + b, 0.0225), (1.05 + c, 1.62 + e, 0.0225), 0.006, 6)
            for a, b, c, e in ((-0.277, 0, 0.277, 0), (0, -0.277, 0, 0.277), (-0.277, 0, 0, 0.277),
                               (0, 0.277, 0.277, 0))]
    sticks = [lathe([(0, 0), (0.006, 0), (0.006, 0.07), (0, 0.07)], 8).moved(
        translate(x, 0.9405, 0.06) @ rotate("z", 90) @ rotate("x", 5 * k))
        for k, x in enumerate((-0.6, -0.42, 0.2, 0.9))]
    sponge = chamfer((0.45, 0.934, 0.03), (0.59, 0.985, 0.09), 0.012)
    s.mesh("blackboard", [(board, "board"), (join(rim + [tray]), "oak"),
                          (join(chalk + [ring] + line + sticks), "chalk"),
                          (sponge, "yellow")])
    s.place("blackboard", (-0.25, 0, -d))
    # the teacher's desk and chair
    top = f.table(1.5, 0.72, 0.76)
    chest = [chamfer((0.30, 0.12, -0.30), (0.655, 0.735, 0.28), 0.004)]
    chest += [chamfer((0.32, y, 0.27), (0.64, y + 0.18, 0.292), 0.004) for y in (0.14, 0.335, 0.53)]
    s.mesh("teacher's desk", [(join([top] + chest), "oak")])
    s.place("teacher's desk", (-1.55, 0, -3.05), 180)
    s.mesh("teacher's chair", [(f.wooden_chair(), "oak")])
    s.place("teacher's chair", (-1.35, -0.001, -3.72), 12)
    metal, shade = f.desk_lamp()
    s.mesh("desk lamp", [(metal, "steel"), (shade, "red")])
    s.place("desk lamp", (-2.08, 0.759, -3.10), -20)
    s.mesh("mug", [(f.mug(), "teal")])
    s.place("mug", (-1.16, 0.7595, -3.0), 40)
    for k, t in enumerate(("blue", "green", "red", "yellow")):
        s.place(f"{t} book", (-0.98, 0.7595 + 0.0222 * k, -3.18), (-12, 5, 20, 8)[k])
    s.place("sheet", (-1.5, 0.7595, -3.15), 8)
    pens = [f.pencil()[0].moved(translate(0.02 * np.cos(k * 1.3), 0.10, 0.02 * np.sin(k * 1.3)) @ rotate("y", 70 * k) @
                                rotate("z", 80)) for k in range(5)]
    cup = lathe([(0, 0), (0.034, 0), (0.036, 0.1), (0.033, 0.1), (0.031, 0.004), (0, 0.004)], 24)
    s.mesh("pencil cup", [(cup, "black"), (join(pens), "yellow")])
    s.place("pencil cup", (-1.28, 0.7595, -3.26))
    # clock over the board, pin board with papers to its right
    clock = lathe([(0.17, 0), (0.17, 0.04), (0.155, 0.045), (0.15, 0.03)], 40).moved(rotate("x", 90))
    dial = lathe([(0.152, 0.031), (0, 0.031)], 40).moved(rotate("x", 90))
    hands = join([chamfer((-0.006, -0.02, 0.033), (0.006, 0.085, 0.036), 0.001).moved(rotate("z", 50)),
                  chamfer((-0.004, -0.02, 0.0365), (0.004, 0.125, 0.039), 0.001).moved(rotate("z", -60))])
    mark = box((-0.004, 0.12, 0.0305), (0.004, 0.142, 0.0325), "-z")
    marks = join([mark.moved(rotate("z", 30 * k)) for k in range(12)])
    s.mesh("clock", [(join([clock, hands, marks]), "black"), (dial, "paper")])
    s.place("clock", (-0.25, 2.62, -d))
    cork = box((-0.55, -0.50, -0.003), (0.55, 0.50, 0.014), "-z")
    rim = [chamfer((-0.58, k * 0.50, -0.003), (0.58, k * 0.535, 0.024), 0.004) for k in (-1, 1)]
    rim += [chamfer((k * 0.55, -0.534, -0.0025), (k * 0.581, 0.534, 0.0235), 0.004) for k in (-1, 1)]
    notes = {}
    for k in range(11):
        x, y = -0.40 + 0.27 * (k % 4) + rs.uniform(-0.02, 0.02), 0.32 - 0.31 * (k // 4) + rs.uniform(-0.02, 0.02)
        a, b = rs.uniform(0.085, 0.115), rs.uniform(0.095, 0.135)
        m = box((-a, -b, 0), (a, b, 0.0012), "-z").moved(
            translate(x, y, 0.0145 + 0.0003 * k) @ rotate("z", rs.uniform(-5, 5)))
        notes.setdefault(("paper", "yellow", "paper", "teal", "red")[k % 5], []).append(m)
    s.mesh("pin board", [(cork, "cork"), (join(rim), "oak")] + [(join(v), k) for k, v in notes.items()])
    s.place("pin board", (2.75, 1.58, -d))


def shelves(s):
    """Bookcases along the right wall, plants on the sills, a globe."""
    rs = np.random.RandomState(8)
    w = WIDTH / 2
    tones = ("red", "blue", "green", "yellow", "teal", "black", "cork")
    for k, z in enumerate((-2.55, -1.30, -0.05)):
        case, heights = f.bookcase(1.18, 1.30, 0.32, 3)
        covers, pages = {}, []
        for level, y in enumerate(heights):
            c, p = f.row_of_books(rs, rs.uniform(0.75, 1.08), 0.31, 0.24, tones)
            for tone, m in c.items():
                covers.setdefault(tone, []).append(m.moved(translate(-0.56, y, 0.30)))
            pages.append(p.moved(translate(-0.56, y, 0.30)))
        s.mesh(f"bookcase {k}", [(case, "beech"), (join(pages), "paper")] + [(join(v), t) for t, v in covers.items()])
        s.place(f"bookcase {k}", (w - 0.012, 0, z), -90)
    ball = sphere(0.16, 36, 18).moved(translate(0, 0.25, 0))
    foot = lathe([(0, 0), (0.10, 0), (0.105, 0.012), (0.03, 0.022), (0.014, 0.04), (0.012, 0.085), (0, 0.09)], 32)
    arc = [(0.18 * np.sin(t), 0.25 + 0.18 * np.cos(t), 0) for t in np.linspace(-0.2, np.pi + 0.05, 14)]
    stand = join([foot, f.tube(arc, 0.006, 8, 0.02)])
    s.mesh("globe", [(ball, "globe"), (stand, "oak")])
    s.place("globe", (w - 0.20, 1.299, -2.75), 60)
    pot, soil = f.pot(0.095, 0.16)
    s.mesh("plant", [(pot, "terracotta"), (soil, "soil"),
                     (f.plant(rs, 20, 0.28, 0.05).moved(translate(0, 0.14, 0)), "leaf")])
    for x, y, z in ((-w - 0.06, SILL + 0.003, -2.9), (-w - 0.07, SILL + 0.003, 0.75), (-w - 0.06, SILL + 0.003, -0.55),
                    (w - 0.2, 1.299, 0.30)):
        s.place("plant", (x, y, z), 80 * z)
    for k, t in enumerate(("yellow", "teal", "red")):
        s.place(f"{t} book", (w - 0.18, 1.2995 + 0.0222 * k, -1.35), 80 + 9 * k)
    s.mesh("bin", [(lathe([(0, -0.001), (0.12, -0.001), (0.15, 0.33), (0.155, 0.335), (0.148, 0.335), (0.117, 0.008),
                           (0, 0.008)], 32),
                    "blue")])
    s.place("bin", (w - 0.35, 0, -3.85))
    chart = box((-0.40, -0.56, 0.002), (0.40, 0.56, 0.005))
    rods = join([f.bar((-0.43, y, 0.006), (0.43, y, 0.006), 0.011, 10) for y in (-0.565, 0.565)])
    cells = [(-0.33 + 0.16 * k, -0.40 + 0.1 * j) for k in range(4) for j in range(8)]
    land = [box((x, y, 0.0045), (x + 0.13, y + 0.075, 0.0065), "-z") for x, y in cells if rs.uniform() < 0.75]
    s.mesh("chart", [(chart, "paper"), (rods, "black"), (join(land[0::3]), "teal"), (join(land[1::3]), "yellow"),
                     (join(land[2::3]), "red")])
    for z in (-2.2, -0.6):
        s.place("chart", (w, 2.18, z), -90)


def main():
    s = Scene("classroom")
    materials(s)
    architecture(s)
    pupils(s)
    front(s)
    shelves(s)
    hdr(os.path.join(s.folder, "sky.hdr"), sky())
    s.sun("sun", SUN, (1.0, 0.94, 0.84), 14.0)
    s.camera("main", (2.75, 1.52, 4.15), (-1.25, 1.52, -4.4), yfov=50.0)
    env = {"file": "sky.hdr", "scale": 3}
    s.extras = {"environment": env}
    x = -WIDTH / 2 - 0.30    # just outside the frames
    for k, (a, b) in enumerate(WINDOWS):
        s.portal(f"sky portal {k + 1}", quad((x, SILL, b), (x, SILL, a), (x, HEAD, a), (x, HEAD, b)))
    s.write("A classroom with twenty desks on thin legs, chairs, books, pencils and shelves, lit through its windows by sun "
            "and sky and by panels in the ceiling: many small objects, the hard case for caching.",
            {"film.ev": 0.6, "environment": env})


if __name__ == "__main__":
    main()
