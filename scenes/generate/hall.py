"""An arcaded hall in plain colours (`hall`): two storeys of arches about a court, lit through its roof by the sun alone.

x to the right, y up; the hall runs along z. The sun falls steeply through three wide shafts in the roof on the left half
of the pavement and on the left arcade. The vaulted aisles behind the columns see no sun at all: what is bright there has
been reflected once by stone or by the cloths, and more often twice. No textures, no gloss: every surface is Lambertian.
"""
import numpy as np

import atrium_parts as ap
import furniture
from gltf import Scene, join
from shapes import box, chamfer, facing, grid, lathe, rotate, slab, translate

BAY, BAYS = 3.2, 7
Z_NEAR, Z_FAR = 0.5 * BAY * BAYS, -0.5 * BAY * BAYS
AXIS, OUTER = 3.7, 6.7           # the arcades' axis, inner face of the outer wall
WALL, WALL2 = 0.56, 0.42         # the arcades' thickness below and above
SPRING, VAULT = 2.85, 1.38       # lower columns' height, rise of the aisles' vaults
LEVEL, GALLERY = 4.45, 4.75      # top of the lower wall, gallery's floor
SPRING2, CEILING2 = 6.75, 7.85   # upper arches spring, gallery's ceiling
ROOF, SHAFT = 8.6, 1.0           # the court's ceiling, height of the shafts above it
OPENING = (2.5, 2.55)            # half width and half length of a shaft
SHAFTS = (6.4, 0.0, -6.4)
SUN = np.array([-0.27, -1.0, -0.14])


def materials(s):
    def matt(name, *c, double=False):
        s.material(name, c, lambert=True, double=double)
    matt("stone", 0.63, 0.58, 0.50)
    matt("pale stone", 0.72, 0.68, 0.61)
    matt("plaster", 0.75, 0.725, 0.675)
    matt("floor", 0.55, 0.505, 0.435)
    matt("dark floor", 0.26, 0.20, 0.165)
    matt("dado", 0.36, 0.20, 0.14)
    matt("wood", 0.30, 0.19, 0.11)
    matt("iron", 0.08, 0.08, 0.085)
    matt("terracotta", 0.50, 0.235, 0.125)
    matt("soil", 0.08, 0.055, 0.04)
    matt("leaves", 0.11, 0.24, 0.06, double=True)
    matt("red cloth", 0.66, 0.05, 0.04, double=True)
    matt("green cloth", 0.07, 0.38, 0.11, double=True)
    matt("blue cloth", 0.06, 0.15, 0.52, double=True)
    matt("saffron cloth", 0.72, 0.40, 0.05, double=True)


def bays():
    return [Z_NEAR - BAY * (i + 0.5) for i in range(BAYS)]


def sides():
    """(sign of x, yaw that turns a part facing +z towards the court)."""
    return ((1, -90.0), (-1, 90.0))


def groin_vault(across, along, rise, steps=8, fan=12):
    """A cross vault over 2 across (x) by 2 along (z), its corners at y = 0, seen from below: four webs that meet in sharp
    groins, each a piece of an elliptic barrel."""
    webs = []
    for turn, (a, b) in enumerate(((across, along), (along, across)) * 2):
        s = np.linspace(0, 1, steps + 1)[:, None]
        t = np.sin(np.linspace(-np.pi / 2, np.pi / 2, fan + 1))[None, :]
        u, z = a * s * t, b * s + 0 * t
        root = np.sqrt(np.clip(1 - (u / a) ** 2, 0, 1))
        n = np.stack([-u / a * rise, -root * a, 0 * u], 2)
        m = facing(grid(np.stack([u, rise * root, z], 2), n.reshape(-1, 3)))
        webs.append(m.moved(rotate("y", 90.0 * turn)))
    return join(webs)


def column(height, r, segments):
    """Base, shaft and a cushion capital under a square abacus."""
    k = r / 0.26
    p = [(0.37 * k, 0.13 * k)] + ap.torus_profile(0.33 * k, 0.135 * k, 0.225 * k, 0.04 * k, 4)
    p += [(0.315 * k, 0.235 * k), (0.295 * k, 0.262 * k)]
    p += ap.torus_profile(0.285 * k, 0.27 * k, 0.32 * k, 0.026 * k, 3)
    p += [(0.28 * k, 0.33 * k), (r, 0.38 * k)]
    neck = height - 0.50 * k
    p += ap.shaft_profile(r, 0.86 * r, 0.40 * k, neck - 0.06 * k, 5)[1:]
    p += ap.torus_profile(0.87 * r, neck - 0.045 * k, neck, 0.026 * k, 3)
    p += [(0.87 * r, neck + 0.005 * k), (0.90 * r, neck + 0.08 * k), (1.02 * r, neck + 0.19 * k),
          (1.22 * r, neck + 0.28 * k),
          (1.34 * r, neck + 0.325 * k), (1.36 * r, neck + 0.345 * k)]
    half = 1.42 * r
    return join([chamfer((-0.375 * k, -0.002, -0.375 * k), (0.375 * k, 0.135 * k, 0.375 * k), 0.012 * k),
                 lathe(p, segments, smooth=40),
                 chamfer((-half * 0.92, neck + 0.335 * k, -half * 0.92), (half * 0.92, neck + 0.41 * k, half * 0.92),
                         0.012 * k),
                 chamfer((-half, neck + 0.40 * k, -half), (half, height + 0.004, half), 0.012 * k)])


def arcades(s):
    s.mesh("column", [(column(SPRING, 0.26, 18), "pale stone")])
    s.mesh("small column", [(column(SPRING2 - GALLERY, 0.125, 10), "pale stone")])
    lower = ap.arch_panel(BAY, 0, 0, LEVEL - SPRING + 0.05, 1.27, WALL, 26).moved(translate(0, SPRING, 0))
    s.mesh("arch", [(lower, "stone")])
    ring = [ap.archivolt(1.27, 0.25, 0.045, k * WALL / 2, 18, side=k) for k in (1, -1)]
    ring += [ap.keystone(1.27, 0.25, 0.045, k * WALL / 2, side=k) for k in (1, -1)]
    s.mesh("archivolt", [(join(ring).moved(translate(0, SPRING, 0)), "pale stone")])
    upper = ap.arch_panel(BAY / 2, 0, 0, ROOF - SPRING2 + 0.05, 0.64, WALL2, 18).moved(translate(0, SPRING2, 0))
    s.mesh("small arch", [(upper, "stone")])
    ring = [ap.archivolt(0.64, 0.12, 0.028, k * WALL2 / 2, 10, side=k) for k in (1, -1)]
    s.mesh("small archivolt", [(join(ring).moved(translate(0, SPRING2, 0)), "pale stone")])
    s.mesh("balustrade", [(ap.balustrade(BAY / 2, 5).moved(translate(0, -0.002, 0)), "pale stone")])
    course = [(0, 0), (0.05, 0.03), (0.05, 0.10), (0.10, 0.20), (0.16, 0.24), (0.20, 0.27), (0.20, 0.33), (0, 0.35)]
    s.mesh("string course", [(ap.cornice(BAY, course, 0.16).moved(translate(0, LEVEL - 0.03, WALL / 2)), "pale stone")])
    crown = [(0, 0), (0.06, 0.04), (0.06, 0.14), (0.14, 0.24), (0.24, 0.30), (0.30, 0.33), (0.30, 0.42), (0, 0.46)]
    s.mesh("cornice", [(ap.cornice(BAY, crown, 0.2).moved(translate(0, ROOF - 0.455, WALL2 / 2)), "pale stone")])
    for x, yaw in sides():
        for i in range(BAYS + 1):
            s.place("column", (x * AXIS, 0, Z_NEAR - BAY * i))
        for i in range(2 * BAYS + 1):
            s.place("small column", (x * AXIS, GALLERY, Z_NEAR - BAY / 2 * i))
        for z in bays():
            for part in ("arch", "archivolt", "string course", "cornice"):
                s.place(part, (x * AXIS, 0, z), yaw)
            for half in (-BAY / 4, BAY / 4):
                s.place("small arch", (x * AXIS, 0, z + half), yaw)
                s.place("small archivolt", (x * AXIS, 0, z + half), yaw)
                s.place("balustrade", (x * AXIS, GALLERY, z + half), yaw)


def aisles(s):
    """Vaults, galleries and outer walls. What closes the building overlaps, so that no light finds a seam."""
    inner = AXIS + WALL / 2
    mid, half = (inner + OUTER) / 2, (OUTER - inner) / 2
    s.mesh("vault", [(groin_vault(half + 0.01, BAY / 2, VAULT), "plaster")])
    length = Z_NEAR - Z_FAR
    floor_lo = AXIS - WALL / 2 + 0.006
    s.mesh("gallery", [(box((floor_lo, SPRING + VAULT + 0.02, -length / 2 - 0.2),
                            (OUTER + 0.2, GALLERY, length / 2 + 0.2)),
                        "stone"),
                       (box((AXIS + WALL2 / 2 - 0.1, CEILING2, -length / 2 - 0.2),
                            (OUTER + 0.2, ROOF + 0.1, length / 2 + 0.2)),
                        "plaster")])
    s.mesh("outer wall", [(slab((OUTER, -0.1, -length / 2 - 0.4), (OUTER + 0.45, ROOF + 0.2, length / 2 + 0.4), "x"),
                           "plaster")])
    pilaster = join([chamfer((-0.22, 0.30, -0.01), (0.22, SPRING - 0.30, 0.10), 0.012),
                     chamfer((-0.27, -0.002, -0.012), (0.27, 0.31, 0.15), 0.015),
                     chamfer((-0.26, SPRING - 0.31, -0.012), (0.26, SPRING - 0.22, 0.14), 0.012),
                     chamfer((-0.30, SPRING - 0.23, -0.014), (0.30, SPRING - 0.08, 0.18), 0.015),
                     chamfer((-0.35, SPRING - 0.09, -0.016), (0.35, SPRING + 0.02, 0.24), 0.015)])
    s.mesh("pilaster", [(pilaster, "pale stone")])
    s.mesh("dado", [(box((-BAY / 2, -0.002, -0.01), (BAY / 2, 1.0, 0.035), "-x +x -z"), "dado"),
                    (ap.cornice(BAY, [(0.0, 0), (0.055, 0.004), (0.075, 0.04), (0.07, 0.075), (0.0, 0.085)]).moved(
                        translate(0, 0.985, 0.0)), "pale stone"),
                    (box((-BAY / 2, -0.002, 0.0), (BAY / 2, 0.16, 0.06), "-x +x -z"), "pale stone")])
    beam = [chamfer((-0.09, CEILING2 - 0.24, -1.5), (0.09, CEILING2 + 0.01, 1.5), 0.012)]
    s.mesh("beams", [(join([beam[0].moved(translate(x, 0, 0)) for x in (-BAY / 4, BAY / 4)]), "wood")])
    # a niche a bay in the gallery's outer wall would be invisible: a plain band instead
    s.mesh("band", [(box((-BAY / 2, 5.70, -0.01), (BAY / 2, 5.80, 0.03), "-x +x -z"), "dado")])
    for x, yaw in sides():
        for z in bays():
            s.place("vault", (x * mid, SPRING, z))
            s.place("dado", (x * OUTER, 0, z), yaw)
            s.place("beams", (x * mid, 0, z), yaw)
            s.place("band", (x * OUTER, 0, z), yaw)
        for i in range(BAYS + 1):
            s.place("pilaster", (x * OUTER, 0, Z_NEAR - BAY * i), yaw)
        s.place("gallery", (0, 0, 0), 0 if x > 0 else 180)
        s.place("outer wall", (0, 0, 0), 0 if x > 0 else 180)


def court(s):
    """Pavement, roof with its shafts, and the end walls."""
    length, wide = Z_NEAR - Z_FAR, OUTER + 0.5
    s.mesh("ground", [(slab((-wide, -0.5, -length / 2 - 0.5), (wide, 0, length / 2 + 0.5), "y"), "floor")])
    tiles = []
    for k in (-1, 1):
        tiles.append(chamfer((k * 3.10, -0.001, -length / 2 - 0.1), (k * 2.75, 0.004, length / 2 + 0.1), 0.002))
        tiles.append(chamfer((k * 2.62, -0.001, -length / 2 - 0.1), (k * 2.56, 0.004, length / 2 + 0.1), 0.002))
    for i in range(BAYS):
        z = bays()[i]
        m = chamfer((-0.82, -0.001, -0.82), (0.82, 0.004, 0.82), 0.002).moved(translate(0, 0, z) @ rotate("y", 45))
        tiles.append(m)
        for x in (-1, 1):
            tiles.append(chamfer((-0.42, -0.001, -0.42), (0.42, 0.004, 0.42), 0.002).moved(
                translate(x * (OUTER + AXIS) / 2, 0, z) @ rotate("y", 45)))
    s.mesh("pavement", [(join(tiles), "dark floor")])
    a, b = OPENING
    holes = [(-a, a, z - b, z + b) for z in SHAFTS]
    s.mesh("roof", [(slab((-wide, ROOF, -length / 2 - 0.6), (wide, ROOF + SHAFT, length / 2 + 0.6), "y", holes),
                     "plaster")])
    mould = []
    for z in SHAFTS:
        for side in (-1, 1):
            mould.append(chamfer((-a - 0.20, ROOF - 0.07, z + side * b),
                                 (a + 0.20, ROOF + 0.02, z + side * (b + 0.20)), 0.02))
            mould.append(chamfer((side * a, ROOF - 0.068, z - b - 0.19),
                                 (side * (a + 0.198), ROOF + 0.02, z + b + 0.19), 0.02))
    s.mesh("roof mouldings", [(join(mould), "pale stone")])
    beams = [chamfer((-AXIS, ROOF - 0.32, z - 0.16), (AXIS, ROOF + 0.01, z + 0.16),
                     0.02) for z in (9.85, 3.2, -3.2, -9.85)]
    s.mesh("roof beams", [(join(beams), "wood")])
    # end walls: a tall blind arch, a wooden door in it
    wall = slab((-wide, -0.12, -0.45), (wide, ROOF + 0.3, 0.0), "z")
    s.mesh("end wall", [(wall, "plaster")])
    frame = join([ap.archivolt(1.5, 0.34, 0.10, 0.0, 32).moved(translate(0, 3.0, 0)),
                  ap.keystone(1.5, 0.34, 0.10, 0.0).moved(translate(0, 3.0, 0)),
                  chamfer((-1.84, -0.002, -0.01), (-1.5, 2.86, 0.10), 0.015),
                  chamfer((1.5, -0.002, -0.01), (1.84, 2.86, 0.10),
                                                                                  0.015),
                  chamfer((-1.92, 2.85, -0.012), (-1.46, 3.01, 0.15), 0.015),
                  chamfer((1.46, 2.85, -0.012), (1.92, 3.01, 0.15),
                                                                                  0.015)])
    lunette = join([lathe([(1.51, 0.0), (1.51, 0.012), (0.0, 0.012)], 32, arc=180.0).moved(
        translate(0, 3.0, 0) @ rotate("x", 90) @ rotate("y", -90))])
    leaves = []
    for k in (-1, 1):
        leaves.append(chamfer((k * 0.006, 0.006, 0.004), (k * 1.495, 2.99, 0.045), 0.006))
        for y0, y1 in ((0.18, 1.0), (1.12, 1.94), (2.06, 2.86)):
            leaves.append(chamfer((k * 0.16, y0, 0.04), (k * 1.34, y1, 0.062), 0.012))
    s.mesh("portal", [(frame, "pale stone"), (join(leaves), "wood"), (lunette, "dado")])
    s.mesh("round window", [(lathe([(0.95, 0), (0.95, 0.06), (0.86, 0.09), (0.74, 0.04), (0.66, 0.06), (0.66, 0.008),
                                    (0, 0.008)],
                                   48).moved(rotate("x", 90)), "pale stone")])
    course = [(0, 0), (0.05, 0.03), (0.05, 0.10), (0.10, 0.20), (0.16, 0.24), (0.20, 0.27), (0.20, 0.33), (0, 0.35)]
    s.mesh("end course", [(ap.cornice(2 * AXIS - WALL - 0.4, course, 0.16).moved(translate(0, LEVEL - 0.03, 0)),
                           "pale stone")])
    for part in ("ground", "pavement", "roof", "roof mouldings", "roof beams"):
        s.place(part)
    for z, yaw in ((Z_FAR, 0.0), (Z_NEAR, 180.0)):
        for part in ("end wall", "portal", "end course"):
            s.place(part, (0, 0, z), yaw)
        s.place("round window", (0, 6.45, z), yaw)


def furnish(s):
    curtain = [ap.hanging(1.9, 2.25, k, 6.0, 0.075, 36, 18) for k in (1, 2)]
    banner = [ap.hanging(1.7, 3.3, k, 4.0, 0.06, 36, 36) for k in (3, 4)]
    rugs = [ap.rail_cloth(1.05, 1.25, k, nu=22, nv=28) for k in (5, 6)]
    s.mesh("rod", [(ap.rod(2.56, 0.02), "iron")])
    s.mesh("banner rod", [(ap.rod(2 * AXIS - 0.5, 0.028), "iron")])
    colours = ("red", "green", "blue", "saffron")
    for c in colours:
        for k in (0, 1):
            s.mesh(f"{c} curtain {k}", [(curtain[k], f"{c} cloth")])
            s.mesh(f"{c} banner {k}", [(banner[k], f"{c} cloth")])
            s.mesh(f"{c} rug {k}", [(rugs[k], f"{c} cloth")])
    zs = bays()
    # curtains hang in the arches, drawn to one side
    for x, i, c, k, off in ((1, 2, "red", 0, 0.22), (1, 3, "saffron", 1, 0.25), (1, 4, "green", 1, -0.22),
                            (1, 5, "blue", 0, 0.22),
                            (-1, 1, "blue", 1, 0.2), (-1, 3, "red", 0, -0.2), (-1, 5, "green", 1, 0.2)):
        yaw = -90.0 * x
        s.place(f"{c} curtain {k}", (x * AXIS, SPRING - 0.03, zs[i] + off), yaw)
        s.place("rod", (x * AXIS, SPRING - 0.02, zs[i]), 90)
    for x, i, half, c, k in ((1, 1, 1, "saffron", 0), (1, 3, -1, "blue", 1), (1, 5, 1, "red", 0),
                             (-1, 2, 1, "green", 1), (-1, 3, -1, "saffron", 0), (-1, 4, 1, "blue", 1),
                             (-1, 5, -1, "red", 0)):
        s.place(f"{c} rug {k}", (x * AXIS, GALLERY + 1.0, zs[i] + half * BAY / 4), -90.0 * x)
    for z, c, k, x in ((3.2, "red", 0, -1.1), (3.2, "saffron", 1, 1.2), (-3.2, "green", 1, -1.3),
                       (-3.2, "blue", 0, 1.1)):
        s.place(f"{c} banner {k}", (x, 7.33, z))
    for z in (3.2, -3.2):
        s.place("banner rod", (0, 7.345, z))
    urn = ap.urn(segments=28)
    s.mesh("urn", [(urn, "terracotta")])
    rs = np.random.RandomState(5)
    pot, soil = furniture.pot(0.30, 0.52, 0.02)
    s.mesh("plant", [(pot, "terracotta"), (soil, "soil"),
                     (furniture.plant(rs, 24, 0.85, 0.16, 0.8).moved(translate(0, 0.48, 0)), "leaves")])
    for x, z, yaw in ((2.62, 4.8, 0), (2.62, -1.6, 50), (-2.62, 1.6, 140), (-2.62, -4.8, 200), (2.62, -8.0, 20)):
        s.place("plant", (x, -0.001, z), yaw)
    s.mesh("bench", [(ap.bench(), "wood")])
    for x, z in ((OUTER - 0.34, zs[2]), (OUTER - 0.34, zs[4]), (-OUTER + 0.34, zs[3])):
        s.place("bench", (x, -0.001, z), 90.0)
    s.place("urn", (OUTER - 0.45, -0.001, zs[3] - 0.2), 30)
    s.place("urn", (OUTER - 0.42, -0.001, zs[5] + 0.5), 70, scale=0.8)
    # a fountain in the middle of the court
    basin = lathe([(0, 0), (1.16, 0), (1.16, 0.06), (1.08, 0.10), (1.08, 0.40), (1.14, 0.45), (1.15, 0.50),
                   (1.11, 0.53),
                   (0.98, 0.53), (0.95, 0.50), (0.93, 0.30), (0.20, 0.24), (0.13, 0.32), (0.10, 0.60), (0.13, 0.84),
                   (0.20, 0.90), (0.46, 0.98), (0.50, 1.02), (0.47, 1.04), (0.20, 0.98), (0.07, 0.98), (0.05, 1.2),
                   (0.075, 1.26), (0.05, 1.33), (0, 1.36)], 48)
    s.mesh("fountain", [(basin, "pale stone")])
    s.place("fountain", (0, 0.003, 0))


def main():
    s = Scene("hall")
    materials(s)
    arcades(s)
    aisles(s)
    court(s)
    furnish(s)
    s.sun("sun", SUN, (1.0, 0.93, 0.82), 20.0)
    s.camera("main", (5.85, 1.62, 10.35), (2.7, 1.62, -2.0), yfov=52.0)
    s.camera("court", (1.2, 1.62, 10.4), (-0.6, 1.62, -10.0), yfov=52.0)
    s.write("An arcaded hall of two storeys without textures, every surface Lambertian, lit by the sun through the roof alone: "
            "under the vaults secondary and tertiary light are all there is, coloured by hanging cloths.",
            {"film.ev": 1.45})


if __name__ == "__main__":
    main()
