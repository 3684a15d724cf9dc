"""A bedroom lit only by the sky in one small window (`window`).

x to the right, y up, the bed's head at z = -2.4, the window in the left wall. No sun, no lamp: a path finds light only
where it leaves through less than a square metre, so path tracing has its hardest case here, and shadows have no edges.
"""
import os

import numpy as np

import atrium_parts as ap
import furniture as f
import rooms
from gltf import Scene, hdr, join
from shapes import chamfer, grid, lathe, rotate, translate

WIDTH, DEPTH, HEIGHT = 4.3, 4.9, 2.58
WINDOW = (-1.62, -0.70, 1.02, 2.06)          # z and y of the opening in the left wall
BED = (0.62, 1.50, 2.02)                     # middle's x, width, length
FAR = -DEPTH / 2


def sky(width=64):
    """An overcast sky, three times as bright overhead as at the horizon, over dark ground: (h, w, 3) radiance."""
    h = width // 2
    v = (np.arange(h) + 0.5) / h
    up = np.repeat(np.cos(np.pi * v)[:, None], width, 1)[..., None]
    colour = (1 + 2 * np.clip(up, 0, 1)) / 3 * np.array([0.93, 1.0, 1.10])
    ground = np.clip(-up / 0.06, 0, 1)
    return colour * (1 - ground) + ground * np.array([0.085, 0.095, 0.06])


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    matt("wall", 0.73, 0.70, 0.64)
    matt("far wall", 0.30, 0.40, 0.41)
    matt("ceiling", 0.79, 0.785, 0.77)
    matt("white wood", 0.76, 0.755, 0.74)
    for k, c in enumerate(((0.50, 0.355, 0.215), (0.46, 0.325, 0.195), (0.53, 0.38, 0.235), (0.48, 0.34, 0.205))):
        matt(f"boards {k}", *c)
    matt("dark", 0.05, 0.045, 0.04)
    matt("oak", 0.47, 0.315, 0.18)
    matt("walnut", 0.19, 0.11, 0.065)
    matt("linen", 0.77, 0.755, 0.72, double=True)
    matt("mustard", 0.62, 0.38, 0.07, double=True)
    matt("rust", 0.48, 0.16, 0.075, double=True)
    matt("wool", 0.64, 0.585, 0.49)
    matt("wool border", 0.44, 0.20, 0.13)
    matt("paper", 0.74, 0.73, 0.69)
    matt("blue", 0.09, 0.18, 0.36)
    matt("green", 0.13, 0.27, 0.15)
    matt("black", 0.04, 0.04, 0.042)
    matt("terracotta", 0.54, 0.26, 0.15)
    matt("soil", 0.08, 0.055, 0.04)
    matt("leaf", 0.12, 0.27, 0.07, double=True)
    s.material("glaze", (0.62, 0.64, 0.60), rough=0.25)
    s.material("brass", (0.80, 0.62, 0.32), rough=0.45, metal=1.0)


def architecture(s):
    w = WIDTH / 2
    sh = rooms.shell(WIDTH, DEPTH, HEIGHT, 0.34, {"-x": [WINDOW]})
    s.mesh("walls", [(join([sh[k] for k in ("-x", "+x", "+z")]), "wall"), (sh["-z"], "far wall")])
    s.mesh("ceiling", [(sh["ceiling"], "ceiling")])
    s.mesh("subfloor", [(sh["floor"], "dark")])
    s.mesh("boards", [(m, f"boards {k}") for k, m in enumerate(rooms.planks(WIDTH - 0.006, DEPTH - 0.006, 0.15, 2.2))])
    s.place("walls")
    s.place("ceiling")
    for name in ("subfloor", "boards"):
        s.place(name, (0, -0.02, 0))
    s.mesh("skirting", [(rooms.skirting(WIDTH, DEPTH, 0.12, 0.018), "white wood")])
    s.place("skirting")
    z0, z1, y0, y1 = WINDOW
    frame = rooms.window(z1 - z0, y1 - y0, 2, 2, 0.055, 0.035, 0.06)
    sill = chamfer((-0.07, -0.032, -0.03), (z1 - z0 + 0.07, 0.004, 0.31), 0.008)
    wide = 0.075
    lining = [chamfer((a, -0.03, 0.255), (b, y1 - y0 + 0.0, 0.285),
                      0.005) for a, b in ((-wide, 0), (z1 - z0, z1 - z0 + wide))]
    lining.append(chamfer((-wide - 0.01, y1 - y0 + 0.0005, 0.254),
                          (z1 - z0 + wide + 0.01, y1 - y0 + wide, 0.289), 0.005))
    s.mesh("window", [(join([frame, sill] + lining), "white wood")])
    s.place("window", (-w - 0.26, y0, z1), 90)
    s.mesh("radiator", [(rooms.radiator(0.84, 0.56), "white wood")])
    s.place("radiator", (-w + 0.014, 0, (z0 + z1) / 2), 90)


def draped(half, top, drop, length, seed, lift=0.0, nz=56, folds=1.0):
    """A cover over a bed along z from 0 to `length`: flat to `half` on both sides, round over the edges, hanging `drop`."""
    rs = np.random.RandomState(seed)
    ph = rs.uniform(0, 2 * np.pi, 8)
    r = 0.06 + lift
    flat = np.linspace(-half, half, 27)
    bend = np.radians(np.linspace(0, 90, 6))[1:]
    down = np.linspace(0, 1, 9)[1:]
    right = [(half + r * np.sin(a), top - r * (1 - np.cos(a)), np.sin(a), np.cos(a)) for a in bend]
    right += [(half + r + 0.012 * v, top - r - (drop - r) * v, 1.0, 0.0) for v in down]
    line = [(-x, y, -nx, ny) for x, y, nx, ny in right[::-1]] + [(x, top, 0.0, 1.0) for x in flat] + right
    x, y, nx, ny = (np.array(c)[None, :] for c in zip(*line))
    z = np.linspace(0, length, nz + 1)[:, None]
    hang = np.clip((top - 0.02 - y) / drop, 0, 1)
    side = np.sign(x)
    puff = 0.010 * np.sin(7 * z + 3 * x + ph[0]) * np.sin(5.3 * x + ph[1]) + 0.006 * np.sin(13 * z - 8 * x + ph[2]) + \
        0.004 * np.sin(21 * x + 9 * z + ph[3])
    pleat = 0.017 * (np.sin(17 * z + side * 1.3 + ph[4]) + 0.5 * np.sin(29 * z + ph[5])) * hang ** 0.8
    hem = 0.03 * hang * np.sin(4.1 * z + side + ph[6])
    out = folds * (puff * (1 - hang) + pleat)
    p = np.stack([x + nx * out, y + ny * out + hem + 0 * z, z + 0 * x], 2)
    m = grid(p)
    up = m.n[:, 1].sum() > 0
    return m if up else m.flipped()


def bed(s):
    x, w, length = BED
    h = w / 2
    wood = [chamfer((-h - 0.03, -0.001, 0.03), (h + 0.03, 1.02, 0.075), 0.012),
            chamfer((-h - 0.045, 1.0, 0.022), (h + 0.045, 1.045, 0.085), 0.012)]
    wood += [chamfer((k * (h - 0.02), 0.20, 0.06), (k * (h + 0.015), 0.34, length + 0.05), 0.006) for k in (-1, 1)]
    wood.append(chamfer((-h - 0.014, 0.198, length + 0.02), (h + 0.014, 0.338, length + 0.055), 0.006))
    wood += [chamfer((k * (h - 0.045), -0.001, length - 0.01), (k * (h + 0.012), 0.21, length + 0.05),
                     0.006) for k in (-1, 1)]
    mattress = chamfer((-h + 0.03, 0.26, 0.08), (h - 0.03, 0.50, length + 0.01), 0.05)
    s.mesh("bed", [(join(wood), "oak"), (mattress, "linen"),
                   (draped(h - 0.05, 0.535, 0.24, 1.40, 3).moved(translate(0, 0, 0.66)), "linen"),
                   (draped(h - 0.045, 0.558, 0.26, 0.52, 6, 0.006, 24, 0.5).moved(translate(0, 0, 1.44)), "mustard")])
    s.place("bed", (x, 0, FAR))
    s.mesh("pillow", [(f.pillow(0.62, 0.10), "linen")])
    s.mesh("cushion", [(f.pillow(0.42, 0.085), "rust")])
    for k in (-1, 1):
        m = translate(x + 0.355 * k, 0.70, FAR + 0.24) @ rotate("y", 4 * k) @ rotate("x", 58)
        s.place("pillow", matrix=m, name=f"pillow {k}")
    s.place("cushion", matrix=translate(x - 0.10, 0.70, FAR + 0.46) @ rotate("y", 10) @ rotate("x", 62), name="cushion")
    # bedside table, lamp, book
    night = [chamfer((-0.23, 0.47, 0.02), (0.23, 0.495, 0.40), 0.005),
             chamfer((-0.21, 0.28, 0.04), (0.21, 0.472, 0.375), 0.004),
             chamfer((-0.195, 0.295, 0.365), (0.195, 0.455, 0.388), 0.004)]
    night += [f.leg((a * 0.18, b), (a * 0.20, b + 0.02 * (1 if b > 0.2 else -1)), 0.019,
                    0.29) for a in (-1, 1) for b in (0.08, 0.33)]
    pull = lathe([(0.007, 0), (0.006, 0.012), (0.013, 0.02), (0.010, 0.028), (0, 0.03)], 16).moved(
        translate(0, 0.375, 0.387) @ rotate("x", 90))
    s.mesh("bedside table", [(join(night), "oak"), (pull, "brass")])
    at = (x - h - 0.36, 0, FAR)
    s.place("bedside table", at)
    lamp = lathe([(0, -0.001), (0.06, -0.001), (0.075, 0.02), (0.095, 0.09), (0.085, 0.15), (0.04, 0.21),
                  (0.018, 0.235),
                  (0.014, 0.29), (0, 0.29)], 40)
    shade = lathe([(0.155, 0.25), (0.157, 0.25), (0.105, 0.45), (0.103, 0.45), (0.155, 0.25)], 40)
    s.mesh("lamp", [(lamp, "glaze"), (shade, "linen")])
    s.place("lamp", (at[0] - 0.05, 0.495, FAR + 0.19))
    cover, pages = f.flat_book(0.14, 0.026, 0.20)
    s.mesh("book", [(cover, "blue"), (pages, "paper")])
    s.place("book", (at[0] + 0.11, 0.4945, FAR + 0.27), -18)


def furnish(s):
    w = WIDTH / 2
    rs = np.random.RandomState(17)
    field, border = f.rug(2.3, 1.55)
    s.mesh("rug", [(field, "wool"), (border, "wool border")])
    s.place("rug", (-0.55, 0, 0.05), -3)
    # writing table by the window, its chair pushed back
    s.mesh("table", [(f.table(1.15, 0.56, 0.74), "walnut")])
    s.place("table", (-w + 0.46, 0, -1.10), 90)
    s.mesh("chair", [(f.wooden_chair(), "oak")])
    s.place("chair", (-w + 1.12, -0.001, -0.92), -72)
    metal, shade = f.desk_lamp()
    s.mesh("desk lamp", [(metal, "black"), (shade, "green")])
    s.place("desk lamp", (-w + 0.36, 0.7395, -1.50), -25)
    s.mesh("mug", [(f.mug(), "glaze")])
    s.place("mug", (-w + 0.58, 0.7395, -0.78), 60)
    leaves = join([chamfer((k * 0.002, 0.001, -0.105), (k * 0.15, 0.012, 0.105), 0.004) for k in (-1, 1)])
    cover = chamfer((-0.156, 0, -0.109), (0.156, 0.0025, 0.109), 0.001)
    s.mesh("open book", [(cover, "rust"), (leaves, "paper")])
    s.place("open book", (-w + 0.52, 0.7395, -1.08), 84)
    for k, (tone, turn) in enumerate((("green", 5), ("rust", -10), ("blue", 12))):
        c, p = f.flat_book(0.15 - 0.008 * k, 0.024, 0.21 - 0.012 * k)
        s.mesh(f"pile {k}", [(c, tone), (p, "paper")])
        s.place(f"pile {k}", (-w + 0.40, 0.7395 + 0.0237 * k, -0.68), 90 + turn)
    # bookcase at the far wall, left
    case, heights = f.bookcase(0.92, 1.62, 0.30, 4)
    covers, pages = {}, []
    for level, y in enumerate(heights):
        c, p = f.row_of_books(rs, (0.84, 0.62, 0.80, 0.46)[level], 0.31, 0.22,
                              ("blue", "green", "rust", "black", "paper", "mustard"))
        for tone, m in c.items():
            covers.setdefault(tone, []).append(m.moved(translate(-0.43, y, 0.28)))
        pages.append(p.moved(translate(-0.43, y, 0.28)))
    s.mesh("bookcase", [(case, "walnut"), (join(pages), "paper")] + [(join(v), t) for t, v in covers.items()])
    bx = -1.32
    s.place("bookcase", (bx, 0, FAR + 0.019))
    s.mesh("vase", [(f.vase(0.22), "glaze")])
    s.place("vase", (bx + 0.22, heights[3] - 0.0005, FAR + 0.17))
    pot, soil = f.pot(0.09, 0.15)
    s.mesh("small plant", [(pot, "terracotta"), (soil, "soil"),
                           (f.plant(rs, 22, 0.26, 0.045).moved(translate(0, 0.13, 0)), "leaf")])
    s.place("small plant", (bx - 0.22, 1.6195, FAR + 0.17))
    s.place("small plant", (-w - 0.09, WINDOW[2] + 0.0035, -1.42), 100, scale=0.8)
    c, p = f.flat_book(0.16, 0.03, 0.22)
    s.mesh("top book", [(c, "mustard"), (p, "paper")])
    s.place("top book", (bx + 0.20, 1.6195, FAR + 0.16), 15)
    pot, soil = f.pot(0.17, 0.30)
    s.mesh("big plant", [(pot, "glaze"), (soil, "soil"),
                         (f.plant(rs, 26, 0.75, 0.15, 0.62, 0.25).moved(translate(0, 0.28, 0)), "leaf")])
    s.place("big plant", (-w + 0.42, -0.001, 0.12), 30)
    # pictures over the bed and on the right wall
    for name, size, at, turn, tones in (("hills", (0.70, 0.52), (BED[0] - 0.22, 1.62, FAR), 0,
                                         ("paper", "green", "mustard")),
                                        ("shore", (0.42, 0.52), (BED[0] + 0.50, 1.62, FAR), 0,
                                         ("wool", "rust", "blue"))):
        frame, mat, art = rooms.picture(*size, 0.022, 0.06)
        a, b = size[0] / 2 - 0.082, size[1] / 2 - 0.082
        t = np.linspace(-a, a, 25)
        ridge = -0.35 * b + 0.30 * b * np.sin(4.2 * t / a + 1)
        low = grid(np.stack([np.stack([t, 0 * t - b, 0 * t + 0.0104], 1), np.stack([t, ridge, 0 * t + 0.0104], 1)]))
        low = low if low.n[0, 2] > 0 else low.flipped()
        disc = lathe([(0.16 * b / 0.2 * 0.6, 0.0), (0.16 * b / 0.2 * 0.6, 0.0015), (0, 0.0015)], 32).moved(
            translate(0.35 * a, 0.35 * b, 0.0093) @ rotate("x", 90))
        s.mesh(name, [(frame, "black"), (mat, "paper"), (art, tones[0]), (low, tones[1]), (disc, tones[2])])
        s.place(name, at, turn)
    # a shelf on the right wall, a basket by the bed
    shelf = [chamfer((-0.50, 0, 0), (0.50, 0.03, 0.22), 0.004)]
    shelf += [chamfer((x - 0.015, -0.16, 0.0), (x + 0.015, 0.002, 0.03), 0.003) for x in (-0.36, 0.36)]
    s.mesh("shelf", [(join(shelf), "oak")])
    s.place("shelf", (w - 0.001, 1.42, -0.75), -90)
    c, p = f.row_of_books(rs, 0.42, 0.26, 0.18, ("blue", "rust", "paper", "green"), False)
    s.mesh("shelf books", [(m, k) for k, m in c.items()] + [(p, "paper")])
    s.place("shelf books", (w - 0.195, 1.4498, -1.12), -90)
    s.place("vase", (w - 0.11, 1.4495, -0.45), scale=0.8)
    # a curtain on each side of the window, on a rod
    s.mesh("curtain", [(ap.hanging(0.42, 1.32, 2, 5.0, 0.03, 44, 16), "linen")])
    s.mesh("curtain rod", [(ap.rod(1.85, 0.011), "brass")])
    for z in (WINDOW[0] - 0.26, WINDOW[1] + 0.26):
        s.place("curtain", (-w + 0.10, 2.20, z), 90)
    s.place("curtain rod", (-w + 0.10, 2.212, (WINDOW[0] + WINDOW[1]) / 2), 90)


def main():
    s = Scene("window")
    materials(s)
    architecture(s)
    bed(s)
    furnish(s)
    hdr(os.path.join(s.folder, "sky.hdr"), sky())
    env = {"file": "sky.hdr", "scale": 16}
    s.extras = {"environment": env}
    s.camera("main", (1.30, 1.42, 2.25), (-0.42, 1.42, -2.40), yfov=50.0)
    s.write("A furnished bedroom lit by an overcast sky through one window of less than a square metre, no sun and no lamp: "
            "path tracing's hard case, because few paths leave through the window.",
            {"film.ev": 2.9, "environment": env})


if __name__ == "__main__":
    main()
