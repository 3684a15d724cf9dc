"""Evening in a room whose only light comes through a door that stands ajar (`ajar`).

x to the right, y up; the door is in the far wall at z = -2.8, the lobby behind it reaches to z = -4.6. The one lamp shines
at the top of a black shaft in the lobby's ceiling: from nowhere but a pool on the lobby's floor can it be seen. What leaves
that pool lights the lobby, and a little of both finds its way through the gap into the room. Every surface is Lambertian.
"""
import numpy as np

import furniture as f
import rooms
from gltf import Scene, join
from shapes import box, chamfer, lathe, quad, rotate, slab, translate

WIDTH, DEPTH, HEIGHT, WALL = 4.4, 5.6, 2.9, 0.24
DOOR = (-0.58, 0.44, 2.12)                   # x from, to, and height of the opening in the far wall
OPEN = 46.0                                  # degrees; the leaf hangs at the left and opens into the room
LINING = 0.03
LOBBY = (-1.62, 1.15, -4.60, 2.55)            # x from, to, the far wall's z, and height
LAMP = (-0.20, -3.86)                        # x, z of the shaft
SHAFT, MOUTH, RISE = 0.24, 0.17, 1.30        # the shaft's half width, the mouth's radius, the lamp's height over it
DADO = 0.88


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    matt("wall", 0.45, 0.52, 0.50)
    matt("lobby wall", 0.80, 0.77, 0.71)
    matt("ceiling", 0.78, 0.775, 0.76)
    matt("woodwork", 0.72, 0.71, 0.685)
    for k, c in enumerate(((0.50, 0.345, 0.215), (0.46, 0.31, 0.19), (0.545, 0.385, 0.25), (0.48, 0.33, 0.205))):
        matt(f"boards {k}", *c)
    for k, c in enumerate(((0.66, 0.56, 0.43), (0.63, 0.525, 0.395), (0.685, 0.585, 0.455), (0.645, 0.545, 0.415))):
        matt(f"lobby boards {k}", *c)
    matt("dark", 0.06, 0.05, 0.045)
    matt("baffle", 0, 0, 0)   # so that no light leaves the shaft but the lamp's own
    matt("oak", 0.36, 0.22, 0.115)
    matt("walnut", 0.19, 0.11, 0.065)
    matt("brass", 0.50, 0.36, 0.14)
    matt("red wool", 0.40, 0.095, 0.07)
    matt("cream wool", 0.62, 0.54, 0.42)
    matt("paper", 0.74, 0.71, 0.64)
    matt("blue", 0.10, 0.17, 0.27)
    matt("ochre", 0.60, 0.38, 0.12)
    matt("moss", 0.20, 0.26, 0.12)
    matt("glaze", 0.16, 0.30, 0.33)
    matt("terracotta", 0.46, 0.22, 0.125)
    matt("soil", 0.08, 0.055, 0.04)
    matt("leaf", 0.15, 0.25, 0.09, double=True)
    s.material("lamp", (0, 0, 0), lambert=True, emit=(1.0, 0.77, 0.51), strength=24000.0)


def building(s):
    """Walls, floors and ceilings of both rooms. Slabs reach into each other, and no two of their faces share a plane."""
    w, d, t = WIDTH / 2, DEPTH / 2, WALL
    x0, x1, top = DOOR
    sh = rooms.shell(WIDTH, DEPTH, HEIGHT, t, {"-z": [(x0, x1, -0.2, top)]})
    s.mesh("walls", [(join([sh[k] for k in ("-x", "+x", "-z", "+z")]), "wall")])
    s.mesh("ceiling", [(sh["ceiling"], "ceiling")])
    a, b, far, high = LOBBY
    near = -d - 0.55 * t                     # within the wall between the rooms
    lx, lz, h = LAMP[0], LAMP[1], SHAFT
    s.mesh("lobby walls", [(join([slab((a - t, -0.07, far - 0.6 * t), (a, high + 0.07, near), "x"),
                                  slab((b, -0.075, far - 0.6 * t), (b + t, high + 0.075, near), "x"),
                                  slab((a - 0.8 * t, -0.085, far - t), (b + 0.8 * t, high + 0.085, far), "z")]),
                           "lobby wall")])
    s.mesh("lobby ceiling", [(slab((a - 1.1 * t, high, far - 1.1 * t), (b + 1.1 * t, high + 0.26, near - 0.01), "y",
                                   [(lx - h, lx + h, lz - h, lz + h)]), "ceiling")])
    s.mesh("floor", [(slab((-w - 1.1 * t, -0.30, far - 1.15 * t), (w + 1.1 * t, -0.02, d + 1.1 * t), "y"), "dark")])
    s.mesh("boards", [(m, f"boards {k}") for k, m in enumerate(rooms.planks(WIDTH - 0.006, DEPTH - 0.006, 0.16, 2.4))])
    deep = -d - t - far
    s.mesh("lobby boards", [(m, f"lobby boards {k}") for k, m in
                            enumerate(rooms.planks(deep - 0.006, b - a - 0.006, 0.16, 2.0, seed=5))])
    for name in ("walls", "ceiling", "lobby walls", "lobby ceiling", "floor"):
        s.place(name)
    s.place("boards", (0, -0.02, 0))
    s.place("lobby boards", ((a + b) / 2, -0.02, (far - d - t) / 2), 90)
    # the lamp: a black shaft with a round mouth; the emissive face at its top looks down
    up, e = high + RISE, 0.05
    shaft = [box((-h - e, high + 0.0010, -h - e), (-h + 0.004, up + e, h + e)),
             box((h - 0.004, high + 0.0015, -h - e + 0.001), (h + e, up + e + 0.001, h + e + 0.001)),
             box((-h - 0.002, high + 0.0020, -h - e + 0.002), (h + 0.002, up + e - 0.001, -h + 0.005)),
             box((-h - 0.003, high + 0.0025, h - 0.005), (h + 0.003, up + e - 0.002, h + e - 0.003)),
             box((-h - 0.01, up + 0.004, -h - 0.01), (h + 0.01, up + 0.03, h + 0.01))]
    ring = lathe([(MOUTH, high - 0.006), (0.34, high - 0.006), (0.345, high - 0.002), (0.345, high + 0.004),
                  (MOUTH, high + 0.004), (MOUTH, high - 0.006)], 64)
    k = 0.11
    face = quad((-k, up, -k), (k, up, -k), (k, up, k), (-k, up, k))
    s.mesh("lamp", [(join(shaft + [ring]), "baffle"), (face, "lamp")])
    s.place("lamp", (lx, 0, lz))


def woodwork(s):
    """Cornice, wainscot, skirting, and the door in its frame."""
    w, d, t = WIDTH / 2, DEPTH / 2, WALL
    x0, x1, top = DOOR
    rooms.line_walls(s, WIDTH, DEPTH, HEIGHT, (x0, x1), DADO, 0.088, (3, 3, 8, 6))
    a, b, far, _ = LOBBY
    middle = (a + b) / 2
    s.mesh("lobby skirting", [(rooms.skirting(b - a, -d - t - far, 0.14, 0.018,
                                              {"+z": [(x0 - 0.086 - middle, x1 + 0.086 - middle)]}), "woodwork")])
    s.place("lobby skirting", (middle, 0, (far - d - t) / 2))
    # the lining of the opening, stops on it, mouldings on both sides, the threshold
    g = LINING
    frame = [chamfer((x0 - 0.004, -0.026, -t - 0.003), (x0 + g, top + 0.001, 0.003), 0.002),
             chamfer((x1 - g, -0.026, -t - 0.003), (x1 + 0.004, top + 0.001, 0.003), 0.002),
             chamfer((x0 - 0.002, top - g, -t - 0.002), (x1 + 0.002, top + 0.004, 0.002), 0.002),
             chamfer((x0 + g - 0.003, -0.011, -0.100), (x0 + g + 0.012, top - g + 0.001, -0.055), 0.002),
             chamfer((x1 - g - 0.012, -0.011, -0.100), (x1 - g + 0.003, top - g + 0.001, -0.055), 0.002),
             chamfer((x0 + g - 0.002, top - g - 0.012, -0.099), (x1 - g + 0.002, top - g + 0.002, -0.056), 0.002)]
    sill = chamfer((x0 + 0.002, -0.03, -t - 0.02), (x1 - 0.002, 0.007, 0.02), 0.004)
    trim = rooms.architrave(x1 - x0, top, 0.085, 0.026)
    s.mesh("door frame", [(join(frame + [trim.moved(translate(x0, 0, 0)),
                                         trim.moved(translate(x1, 0, -t) @ rotate("y", 180))]), "woodwork"),
                          (sill, "oak")])
    s.place("door frame", (0, 0, -d))
    leaf, knobs = rooms.door(x1 - x0 - 2 * g - 0.006, top - g - 0.012, ((0.105, 0.42), (0.51, 0.925)))
    s.mesh("door", [(leaf, "woodwork"), (knobs, "brass")])
    s.place("door", (x0 + g + 0.003, 0.009, -d - 0.015), -OPEN)


def furnish(s):
    w, d = WIDTH / 2, DEPTH / 2
    # a plant in the dark corner
    pot, soil = f.pot(0.19, 0.34)
    s.mesh("plant", [(pot, "terracotta"), (soil, "soil"),
                     (f.plant(np.random.RandomState(8), 34, 0.95, 0.085, 0.8).moved(translate(0, 0.31, 0)), "leaf")])
    s.place("plant", (-1.62, -0.001, -2.24))
    # a chair turned to the light, with a rug in the way of it
    s.mesh("chair", [(f.wooden_chair(), "oak")])
    s.place("chair", (1.02, 0.012, -1.12), -152)
    field, border = f.rug(2.2, 1.45)
    inner, band = (m.moved(translate(0, 0.003, 0)) for m in f.rug(1.72, 0.97, 0.013, 0.05))
    s.mesh("rug", [(field, "red wool"), (border, "cream wool"), (band, "ochre"), (inner, "red wool")])
    s.place("rug", (0.62, 0, -0.95), -5)
    # at the right wall a table with a vase and books, a picture over it
    s.mesh("side table", [(f.table(0.92, 0.36, 0.78), "walnut")])
    s.place("side table", (w - 0.235, 0, -1.62), -90)
    top = 0.7792
    rs = np.random.RandomState(4)
    s.mesh("vase", [(f.vase(0.30), "glaze")])
    at = (w - 0.24, top, -1.78)
    s.place("vase", at)
    twigs, leaves = [], []
    for k in range(7):
        a, r = 2.4 * k, rs.uniform(0.06, 0.17)
        end = np.array([r * np.cos(a), 0.29 + rs.uniform(0.18, 0.36), r * np.sin(a)])
        foot = np.array([0.006 * np.cos(a), 0.12, 0.006 * np.sin(a)])
        neck = np.array([0.014 * np.cos(a), 0.30, 0.014 * np.sin(a)])
        twigs.append(f.tube([foot, neck, end], 0.0024, 6, 0.12))
        for j in range(8):
            p = neck + (end - neck) * (0.25 + 0.75 * j / 7)
            leaves.append(f.leaf(rs.uniform(0.055, 0.085), 0.030, 0.5, 6).moved(
                translate(*p) @ rotate("y", 137.5 * j + 40 * k)))
    s.mesh("twigs", [(join(twigs + leaves), "leaf")])
    s.place("twigs", at)
    for k, (tone, size, yaw) in enumerate((("blue", (0.17, 0.034, 0.24), 62), ("ochre", (0.15, 0.026, 0.21), 78))):
        cover, pages = f.flat_book(*size)
        s.mesh(f"book {k}", [(cover, tone), (pages, "paper")])
        s.place(f"book {k}", (w - 0.23, top + 0.0338 * k, -1.36), yaw)
    frame, mat, art = rooms.picture(0.72, 0.56, 0.035, 0.075)
    hill = join([box((-0.245, -0.165, 0.0090), (0.245, -0.04, 0.0106), "-z"),
                 box((-0.245, -0.041, 0.0090), (0.02, 0.012, 0.0103), "-z")])
    s.mesh("picture", [(frame, "walnut"), (mat, "paper"), (art, "cream wool"), (hill, "moss")])
    s.place("picture", (w, 1.66, -1.62), -90)
    frame, mat, art = rooms.picture(0.46, 0.60, 0.028, 0.07)
    shape = lathe([(0.0, 0.0), (0.08, 0.0), (0.08, 0.0022), (0, 0.0022)], 40).moved(
        translate(0.01, 0.04, 0.0090) @ rotate("x", 90))
    s.mesh("print", [(frame, "oak"), (mat, "paper"), (art, "blue"), (shape, "ochre")])
    s.place("print", (1.30, 1.66, -d))
    s.place("print", (-1.45, 1.66, -d))


def main():
    s = Scene("ajar")
    materials(s)
    building(s)
    woodwork(s)
    furnish(s)
    s.camera("main", (-0.45, 1.65, 2.50), (0.42, 1.65, -2.8), yfov=56.0)
    s.camera("lobby", (0.95, 1.65, -4.40), (-0.80, 1.65, -3.45), yfov=74.0)
    s.write("A room lit through a door that stands ajar, by a lamp in a shaft that lights a pool of the next room's floor "
            "and nothing else: nearly all light has been reflected more than twice, and few rays of a record find the pool.",
            {"film.ev": 4.0})


if __name__ == "__main__":
    main()
