"""A quiet room lit by one patch of sun on its floor (`sun-patch`).

x to the right, y up, the far wall at z = -2.6. The sun comes through one small casement in the left wall, out of the
camera's sight, and is the only light there is: it falls on less than a square metre of boards, and whatever else is seen
has been lit by that.
"""
import numpy as np

import furniture as f
import rooms
from gltf import Scene, join
from shapes import box, chamfer, lathe, rotate, translate

WIDTH, DEPTH, HEIGHT = 4.6, 5.2, 2.85
WINDOW = (0.12, 1.00, 0.98, 2.18)           # z and y of the opening in the left wall
DOOR = (0.86, 1.70, 2.08)                    # x from, to, and height, in the far wall
SUN = np.array([1.0, -0.64, -0.82])          # the way it shines
DADO = 0.92


def materials(s):
    def matt(name, *c):
        s.material(name, c, lambert=True)
    matt("wall", 0.68, 0.705, 0.68)
    matt("ceiling", 0.78, 0.775, 0.76)
    matt("woodwork", 0.74, 0.735, 0.715)
    for k, c in enumerate(((0.62, 0.505, 0.375), (0.58, 0.465, 0.335), (0.65, 0.535, 0.40), (0.60, 0.485, 0.355))):
        matt(f"boards {k}", *c)
    matt("dark", 0.06, 0.05, 0.045)
    matt("oak", 0.36, 0.22, 0.115)
    matt("walnut", 0.17, 0.095, 0.055)
    matt("linen", 0.72, 0.69, 0.62)
    matt("red wool", 0.42, 0.085, 0.06)
    matt("cream wool", 0.62, 0.54, 0.42)
    matt("paper", 0.74, 0.71, 0.64)
    matt("blue", 0.10, 0.19, 0.34)
    matt("ochre", 0.60, 0.38, 0.12)
    matt("moss", 0.20, 0.26, 0.12)
    matt("soil", 0.08, 0.055, 0.04)
    matt("terracotta", 0.52, 0.25, 0.14)
    s.material("leaf", (0.13, 0.26, 0.07), lambert=True, double=True)
    s.material("petal", (0.78, 0.66, 0.30), lambert=True, double=True)
    s.material("glaze", (0.09, 0.20, 0.24), rough=0.28)
    s.material("brass", (0.80, 0.62, 0.32), rough=0.45, metal=1.0)


def architecture(s):
    x0, x1, top = DOOR
    holes = {"-x": [WINDOW], "-z": [(x0, x1, -0.2, top)]}
    sh = rooms.shell(WIDTH, DEPTH, HEIGHT, 0.30, holes)
    s.mesh("walls", [(join([sh[k] for k in ("-x", "+x", "-z", "+z")]), "wall")])
    s.mesh("ceiling", [(sh["ceiling"], "ceiling")])
    s.mesh("subfloor", [(sh["floor"], "dark")])
    s.mesh("boards", [(m, f"boards {k}") for k, m in enumerate(rooms.planks(WIDTH - 0.006, DEPTH - 0.006, 0.16, 2.4))])
    s.place("walls")
    s.place("ceiling")
    s.place("subfloor", (0, -0.02, 0))
    s.place("boards", (0, -0.02, 0))
    # cornice, wainscot, door
    w, d = WIDTH / 2, DEPTH / 2
    rooms.line_walls(s, WIDTH, DEPTH, HEIGHT, (x0, x1), DADO, 0.088, (4, 1, 7, 6))
    leaf, knobs = rooms.door(x1 - x0 - 0.036, top - 0.022)
    jamb = [chamfer((x - 0.018 * (x == x1) - 0.002 * (x == x0), -0.001, -0.16),
                    (x + 0.018 * (x == x0) + 0.002 * (x == x1), top + 0.002, 0.003), 0.002) for x in (x0, x1)]
    jamb += [box((x0 + 0.0, top - 0.018, -0.159), (x1, top + 0.002, 0.002)),
             box((x0 - 0.05, -0.1, -0.32), (x1 + 0.05, top + 0.05, -0.20))]
    s.mesh("door", [(join([leaf.moved(translate(x0 + 0.018, 0.004, -0.05)), rooms.architrave(x1 - x0, top, 0.085, 0.026)
                           .moved(translate(x0, 0, 0))] + jamb), "woodwork"),
                    (knobs.moved(translate(x0 + 0.018, 0, -0.05)), "brass")])
    s.place("door", (0, 0, -d))
    # the casement, its sill and its reveal's lining
    z0, z1, y0, y1 = WINDOW
    s.mesh("window", [(join([rooms.window(z1 - z0, y1 - y0, 2, 2, 0.045, 0.03, 0.05),
                             chamfer((-0.08, -0.03, -0.03), (z1 - z0 + 0.08, 0.004, 0.25), 0.006)]), "woodwork")])
    s.place("window", (-w - 0.20, y0, z1), 90)


def furnish(s):
    d = DEPTH / 2
    s.mesh("chair", [(f.wooden_chair(), "oak")])
    s.place("chair", (0.52, -0.001, -1.55), -104)
    s.place("chair", (-1.92, -0.001, -1.22), 70)
    s.mesh("table", [(f.round_table(0.46, 0.73), "walnut")])
    s.place("table", (-1.22, -0.001, -1.72))
    # on the table: a vase with a few stems, a book, a bowl
    rs = np.random.RandomState(4)
    s.mesh("vase", [(f.vase(0.27), "glaze")])
    at = (-1.27, 0.7282, -1.80)
    s.place("vase", at)
    stems, leaves, flowers = [], [], []
    for k in range(9):
        a, r = 2.4 * k, rs.uniform(0.05, 0.17)
        h = rs.uniform(0.20, 0.36)
        end = np.array([r * np.cos(a), 0.25 + h, r * np.sin(a)])
        stems.append(f.tube([(0.004 * np.cos(a), 0.10, 0.004 * np.sin(a)), (0.012 * np.cos(a), 0.27, 0.012 * np.sin(a)),
                             end], 0.0022, 6, 0.12))
        for j in range(3):
            leaves.append(f.leaf(rs.uniform(0.07, 0.12), 0.028, 0.5).moved(
                translate(*(end * (0.72, 0.80, 0.72) + (0, 0.02 * j, 0))) @ rotate("y", 120 * j + 40 * k)))
        petals = [f.leaf(0.034, 0.022, 0.25, 4, 0.7).moved(rotate("y", 72 * j + 36 * ring) @ rotate("x", -30 * ring))
                  for ring in range(2) for j in range(5)]
        flowers.append(join(petals).moved(translate(*end) @ rotate("z", -40 * np.cos(a)) @ rotate("x", 40 * np.sin(a))))
    s.mesh("flowers", [(join(stems + leaves), "leaf"), (join(flowers), "petal")])
    s.place("flowers", at)
    cover, pages = f.flat_book(0.16, 0.028, 0.22)
    s.mesh("book", [(cover, "blue"), (pages, "paper")])
    s.place("book", (-1.00, 0.7282, -1.55), 24)
    s.mesh("bowl", [(f.bowl(0.11, 0.06), "terracotta")])
    s.place("bowl", (-1.44, 0.7282, -1.50))
    # pictures above it, a narrow rug in the sun's way, a chest at the right wall
    frame, mat, art = rooms.picture(0.62, 0.78, 0.035, 0.085)
    hill = join([box((-0.17, -0.25, 0.0090), (0.17, -0.06, 0.0106), "-z"),
                 box((-0.10, -0.06, 0.0092), (0.02, 0.05, 0.0108),
                                                                             "-z")])
    s.mesh("picture", [(frame, "walnut"), (mat, "paper"), (art, "cream wool"), (hill, "moss")])
    s.place("picture", (-1.52, 1.66, -d))
    frame, mat, art = rooms.picture(0.44, 0.56, 0.028, 0.065)
    shape = lathe([(0.0, 0.0), (0.075, 0.0), (0.075, 0.0022), (0, 0.0022)], 40).moved(
        translate(0.01, 0.03, 0.0090) @ rotate("x", 90))
    s.mesh("print", [(frame, "oak"), (mat, "paper"), (art, "blue"), (shape, "ochre")])
    s.place("print", (-0.72, 1.60, -d))
    s.place("print", (-0.12, 1.60, -d))
    field, border = f.rug(1.7, 1.15)
    s.mesh("rug", [(field, "red wool"), (border, "cream wool")])
    s.place("rug", (-1.12, 0, -1.62), 5)
    chest = [chamfer((-0.55, 0.06, 0.03), (0.55, 0.80, 0.45), 0.004),
             chamfer((-0.575, 0.795, 0.012), (0.575, 0.825, 0.475),
                                                                              0.006)]
    drawers, pulls = [], []
    for k in range(3):
        y = 0.09 + 0.235 * k
        drawers.append(chamfer((-0.525, y, 0.44), (0.525, y + 0.222, 0.462), 0.005))
        for x in (-0.28, 0.28):
            pulls.append(lathe([(0.008, 0), (0.007, 0.012), (0.015, 0.02), (0.012, 0.03), (0, 0.032)], 16).moved(
                translate(x, y + 0.111, 0.461) @ rotate("x", 90)))
    feet = [chamfer((x - 0.035, -0.001, z), (x + 0.035, 0.065, z + 0.06),
                    0.004) for x in (-0.50, 0.50) for z in (0.04, 0.38)]
    s.mesh("chest", [(join(chest + drawers + feet), "oak"), (join(pulls), "brass")])
    s.place("chest", (WIDTH / 2 - 0.035, 0, -0.85), -90)
    s.mesh("pot", [(f.pot(0.11, 0.19)[0], "terracotta"), (f.pot(0.11, 0.19)[1], "soil"),
                   (f.plant(rs, 26, 0.34, 0.055).moved(translate(0, 0.16, 0)), "leaf")])
    s.place("pot", (WIDTH / 2 - 0.28, 0.824, -1.16))
    rs = np.random.RandomState(9)
    covers, pages = f.row_of_books(rs, 0.30, 0.24, 0.17, ("blue", "ochre", "red wool", "moss"), False)
    s.mesh("books", [(m, k) for k, m in covers.items()] + [(pages, "paper")])
    s.place("books", (WIDTH / 2 - 0.18, 0.825, -0.75), -90)


def main():
    s = Scene("sun-patch")
    materials(s)
    architecture(s)
    furnish(s)
    s.sun("sun", SUN, (1.0, 0.92, 0.80), 30.0)
    s.camera("main", (0.28, 1.45, 2.42), (-0.10, 1.45, -2.6), yfov=50.0)
    s.write("A room lit by one patch of sun, less than a square metre of its floor: nearly all light is indirect, and "
            "most of it has been reflected more than twice.", {"film.ev": 2.7})


if __name__ == "__main__":
    main()
