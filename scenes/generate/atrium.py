"""The atrium: the program's default scene. A vaulted hall, nine bays of three metres, arcaded on two storeys.

x to the right, y up, the hall runs from z = +9 (portal, open to the sky) to z = -18 (arch onto a terrace). The sun
comes from the right and the far end, high: through four wide oculi in the vault onto the left half of the pavement and
the left arcade, through the gallery's windows into the gallery. The right arcade stays in the shade and lives on the
bounce. The numbers serve path tracing as much as the eye: wide openings and pale stone, so that most paths find light.
"""
import numpy as np

import atrium_garden as garden
import atrium_parts as ap
import textures
from gltf import Scene, hdr, join
from shapes import box, lathe, planar_uv, quad, rotate, sphere, translate

BAY, BAYS = 3.0, 9
Z_NEAR, Z_FAR = 9.0, -18.0
AXIS, OUTER = 4.0, 7.2            # arcade's axis, inner face of the outer wall
SPRING, CEILING = 2.75, 4.2       # lower arcade springs, aisle's ceiling
GALLERY = 4.55                    # gallery's floor
SPRING2, CEILING2 = 6.5, 7.4      # upper arcade springs, gallery's ceiling
RADIUS, HALF_ARC = 6.5, 0.6435    # the vault: a segment 3.9 m to each side
EAVES = 7.75                      # where the vault springs
AXLE = EAVES - RADIUS * float(np.cos(HALF_ARC))   # height of the vault's axis
WALL, WALL2 = 0.6, 0.45           # arcade walls' thickness below and above
OCULI, OCULUS = (5.0, -1.0, -7.0, -13.0), 2.5
DAIS = 0.6
POOL = (1.05, 3.9, -9.5)          # the basin: half width, near and far end
ROD, RODS = 6.95, (0.0, -6.0, -12.0)   # tie rods; banners hang from them
SUN = np.array([0.36, 1.0, -0.44])   # towards the sun


def materials(s):
    f = s.folder
    maps = {"floor": textures.floor().save(f, "floor"),
            "ashlar": textures.ashlar().save(f, "ashlar"),
            "limestone": textures.limestone().save(f, "limestone", normal=False),
            "plaster": textures.plaster().save(f, "plaster", normal=False),
            "wood": textures.wood().save(f, "wood", normal=False)}
    size = {"floor": 3.0, "ashlar": 3.0, "limestone": 2.0, "plaster": 3.6, "wood": 1.6}
    rough = {"floor": 0.46, "ashlar": 0.9, "limestone": 0.72, "plaster": 0.95, "wood": 0.6}
    for name, m in maps.items():
        s.material(name, (1, 1, 1), rough=rough[name], lambert=name in ("plaster", "wood"), maps=m, metres=size[name])
    s.material("dark stone", (0.19, 0.18, 0.17), rough=0.5, maps=maps["limestone"], metres=2.0)
    s.material("ochre plaster", (0.98, 0.83, 0.62), lambert=True, maps=maps["plaster"], metres=3.6)
    s.material("red plaster", (0.60, 0.15, 0.10), lambert=True, maps=maps["plaster"], metres=3.6)
    textures.png(f + "/cloth_color.png", textures.to_srgb(textures.cloth().color))
    weave = {"color": "cloth_color.png", "through": "cloth_color.png"}
    s.material("cloth saffron", (0.82, 0.46, 0.09), lambert=True, double=True, maps=weave, through=0.6,
               through_color=(1.0, 0.62, 0.13))
    s.material("cloth madder", (0.58, 0.12, 0.07), lambert=True, double=True, maps=weave, through=0.55,
               through_color=(0.98, 0.24, 0.10))
    s.material("cloth linen", (0.74, 0.67, 0.54), lambert=True, double=True, maps=weave, through=0.6,
               through_color=(1.0, 0.90, 0.70))
    s.material("cloth indigo", (0.12, 0.20, 0.42), lambert=True, double=True, maps=weave, through=0.4,
               through_color=(0.18, 0.32, 0.68))
    s.material("brass", (0.91, 0.71, 0.36), rough=0.4, metal=1)
    s.material("water", (0.03, 0.055, 0.05), rough=0, ior=1.33)
    s.material("iron", (0.20, 0.19, 0.18), rough=0.55, metal=1)
    s.material("terracotta", (0.50, 0.235, 0.125), rough=0.8)
    s.material("glass", (1, 1, 1), glass=0, ior=1.5)
    s.material("flame", (0, 0, 0), lambert=True, emit=(1.0, 0.58, 0.24), strength=2.5)
    s.material("opal", (0.6, 0.58, 0.52), lambert=True, emit=(1.0, 0.64, 0.32), strength=1.3)
    s.material("earth", (0.40, 0.34, 0.24), lambert=True)
    s.material("soil", (0.10, 0.07, 0.05), lambert=True)
    s.material("bark", (0.20, 0.15, 0.10), lambert=True)
    s.material("leaves", (0.10, 0.19, 0.05), rough=0.5, double=True, through=0.4, through_color=(0.30, 0.45, 0.06))
    s.material("orange", (0.85, 0.33, 0.03), rough=0.5)
    s.material("cypress", (0.07, 0.11, 0.045), lambert=True)
    s.material("woods", (0.16, 0.22, 0.13), lambert=True)
    s.material("hills", (0.30, 0.37, 0.36), lambert=True)


def bays():
    return [Z_NEAR - BAY * (i + 0.5) for i in range(BAYS)]


def sides():
    """(sign of x, yaw that turns a part facing +z towards the nave)."""
    return ((1, -90.0), (-1, 90.0))


def arcade(s):
    """Both storeys of columns and arches along the hall, with their mouldings and the balustrade."""
    s.mesh("column", [(ap.column(SPRING, 0.27), "limestone")])
    s.mesh("capital", [(join([ap.leaves(0.27, SPRING - 0.62), ap.abacus(0.36, SPRING - 0.15, SPRING)]), "limestone")])
    h2 = SPRING2 - GALLERY
    s.mesh("small column", [(ap.column(h2, 0.125, 11), "limestone")])
    s.mesh("small capital", [(join([ap.leaves(0.125, h2 - 0.62 * 0.125 / 0.27, around=28, along=4),
                                    ap.abacus(0.19, h2 - 0.08, h2 + 0.001)]), "limestone")])
    lower = ap.arch_panel(BAY, 0, 0, CEILING + 0.4 - SPRING, 1.2, WALL).moved(translate(0, SPRING, 0))
    for k in range(4):   # cut from different places of the wall's texture, whole courses apart
        s.mesh(f"arch {k}", [(lower.with_uv(lower.uv + [0.77 * k, 0.75 * k]), "ashlar")])
    ring = [ap.archivolt(1.2, 0.26, 0.05, k * WALL / 2, side=k) for k in (1, -1)]
    ring += [ap.keystone(1.2, 0.26, 0.05, k * WALL / 2, side=k) for k in (1, -1)]
    s.mesh("archivolt", [(join(ring).moved(translate(0, SPRING, 0)), "limestone")])
    upper = ap.arch_panel(BAY / 2, 0, 0, EAVES + 0.3 - SPRING2, 0.58, WALL2, 20).moved(translate(0, SPRING2, 0))
    for k in range(4):
        s.mesh(f"small arch {k}", [(upper.with_uv(upper.uv + [0.71 * k, 0.75 * k]), "ashlar")])
    small = join([ap.archivolt(0.58, 0.13, 0.03, k * WALL2 / 2, 12, side=k) for k in (1, -1)])
    s.mesh("small archivolt", [(small.moved(translate(0, SPRING2, 0)), "limestone")])
    s.mesh("balustrade", [(ap.balustrade(BAY / 2, 6), "limestone")])
    course = [(0, 0), (0.05, 0.03), (0.05, 0.10), (0.10, 0.20), (0.16, 0.24), (0.20, 0.27), (0.20, 0.34), (0, 0.36)]
    s.mesh("string course", [(ap.cornice(BAY, course, 0.15).moved(translate(0, CEILING, WALL / 2)), "limestone")])
    crown = [(0, 0), (0.06, 0.04), (0.06, 0.14), (0.14, 0.24), (0.24, 0.30), (0.30, 0.33), (0.30, 0.42), (0, 0.46)]
    s.mesh("cornice", [(ap.cornice(BAY, crown, 0.2).moved(translate(0, EAVES - 0.46, WALL2 / 2)), "limestone")])
    rs = np.random.RandomState(3)
    for x, yaw in sides():
        for i in range(BAYS + 1):
            at = (x * AXIS, 0, Z_NEAR - BAY * i)
            s.place("column", at, 90.0 * rs.randint(4))
            s.place("capital", at, 90.0 * rs.randint(4))
        for i in range(2 * BAYS + 1):
            at = (x * AXIS, GALLERY, Z_NEAR - BAY / 2 * i)
            s.place("small column", at, 90.0 * rs.randint(4))
            s.place("small capital", at)
        for z in bays():
            for part in (f"arch {rs.randint(4)}", "archivolt", "string course", "cornice"):
                s.place(part, (x * AXIS, 0, z), yaw)
            for half in (-BAY / 4, BAY / 4):
                s.place(f"small arch {rs.randint(4)}", (x * AXIS, 0, z + half), yaw)
                s.place("small archivolt", (x * AXIS, 0, z + half), yaw)
                s.place("balustrade", (x * AXIS, GALLERY, z + half), yaw)


def aisles(s):
    """Floors, ceilings of timber, outer walls with pilasters below and windows above."""
    width = OUTER - AXIS
    mid = (AXIS + OUTER) / 2
    planks = box((-BAY / 2, 0, -width / 2 - 0.1), (BAY / 2, 0.06, width / 2 + 0.2))
    planks = planks.with_uv(np.stack([planks.p[:, 2], planks.p[:, 0]], 1))
    joists = []
    for i in range(5):
        j = box((-BAY / 2 + (i + 0.5) * BAY / 5 - 0.06, -0.16, -width / 2), (-BAY / 2 + (i + 0.5) * BAY / 5 + 0.06, 0.0,
                                                                        width / 2 + 0.1), "+y +z -z")
        joists.append(j.with_uv(np.stack([j.p[:, 0] + j.p[:, 1], j.p[:, 2]], 1)))
    beams = [box((-BAY / 2 - 0.13, -0.40, -width / 2), (-BAY / 2 + 0.13, 0.0, width / 2 + 0.1), "+y +z -z")]
    plates = [box((-BAY / 2, -0.24, z - 0.07), (BAY / 2, -0.16, z + 0.07), "+x -x") for z in (-width / 2 + 0.37,
                                                                                             width / 2 - 0.07)]
    beams[0] = beams[0].with_uv(np.stack([beams[0].p[:, 0] + beams[0].p[:, 1], beams[0].p[:, 2]], 1))
    s.mesh("timber ceiling", [(join([planks] + joists + beams + plates), "wood")])
    # its edge stands out of the arcade's face as a string course: surfaces that share a plane are a fault
    s.mesh("gallery floor", [(box((-BAY / 2, 0.061, -width / 2 - 0.29), (BAY / 2, GALLERY - CEILING, width / 2 + 0.34),
                                  "+x -x"), "floor")])
    # lower outer wall: plaster above a dado, a pilaster at every column
    wall = quad((-BAY / 2, 0, 0), (BAY / 2, 0, 0), (BAY / 2, GALLERY, 0), (-BAY / 2, GALLERY, 0))
    dado = join([ap.cornice(BAY, [(0.05, 0), (0.075, 0.01), (0.09, 0.05), (0.09, 0.08), (0, 0.095)]).moved(
                     translate(0, 0.95, 0)),
                 box((-BAY / 2, 0, 0.05), (BAY / 2, 0.18, 0.085), "-z -y +x -x")])
    pilaster = join([box((-0.24, 0, 0), (0.24, CEILING - 0.40, 0.13), "-z -y"),
                     box((-0.29, 0, 0), (0.29, 0.32, 0.18), "-z -y"),
                     box((-0.29, CEILING - 0.62, 0), (0.29, CEILING - 0.52, 0.18), "-z"),
                     box((-0.33, CEILING - 0.52, 0), (0.33, CEILING - 0.40, 0.22), "-z")])
    s.mesh("aisle wall", [(planar_uv(wall), "ochre plaster")])
    field = box((-BAY / 2, 0.18, 0), (BAY / 2, 0.96, 0.05), "-z -y +x -x +y")
    s.mesh("dado", [(field, "red plaster"), (dado, "limestone")])
    s.mesh("pilaster", [(pilaster, "limestone")])
    # upper outer wall: a window a bay, 1.1 m wide, reveal 0.5 m deep
    sill, head = 0.75, 1.70
    window = ap.arch_panel(2.0, sill, head, CEILING2 + 0.3 - GALLERY, 0.75, 0.5, 20).moved(translate(0, 0, -0.25))
    flanks = [quad((a, sill, 0), (b, sill, 0), (b, CEILING2 + 0.3 - GALLERY, 0), (a, CEILING2 + 0.3 - GALLERY, 0))
              for a, b in ((-BAY / 2, -1.0), (1.0, BAY / 2))]
    below = quad((-BAY / 2, -0.1, 0), (BAY / 2, -0.1, 0), (BAY / 2, sill, 0), (-BAY / 2, sill, 0))
    shelf = box((-0.90, sill - 0.07, -0.55), (0.90, sill, 0.06))
    bars = [box((-0.018, sill, -0.32), (0.018, head + 0.75, -0.28), "-y +y")]
    bars += [box((-0.75, y - 0.018, -0.315), (0.75, y + 0.018, -0.285), "+x -x") for y in (1.22, 1.70)]
    s.mesh("window wall", [(planar_uv(join([window, below] + flanks)), "plaster")])
    s.mesh("window shelf", [(join([shelf]), "limestone")])
    s.mesh("window bars", [(join(bars), "iron")])
    s.mesh("window ring", [(join([ap.archivolt(0.75, 0.14, 0.035, 0.0, 14)]).moved(translate(0, head, 0)),
                            "limestone")])
    for x, yaw in sides():
        for i, z in enumerate(bays()):
            s.place("timber ceiling", (x * mid, CEILING, z), yaw)
            s.place("timber ceiling", (x * mid, CEILING2, z), yaw)
            s.place("gallery floor", (x * mid, CEILING, z), yaw)
            s.place("aisle wall", (x * OUTER, 0, z), yaw)
            s.place("dado", (x * OUTER, 0, z), yaw)
            for part in ("window wall", "window shelf", "window bars", "window ring"):
                s.place(part, (x * OUTER, GALLERY, z), yaw)
        for i in range(1, BAYS):
            s.place("pilaster", (x * OUTER, 0, Z_NEAR - BAY * i), yaw)
    s.mesh("pavement", [(pavement(), "floor")])
    s.place("pavement")
    bands = [quad((k * a, 0.002, Z_NEAR + 4), (k * b, 0.002, Z_NEAR + 4), (k * b, 0.002, Z_FAR), (k * a, 0.002, Z_FAR))
             for a, b in ((3.18, 3.40), (2.94, 3.00)) for k in (-1, 1)]
    bands = [m if m.n[0, 1] > 0 else m.flipped() for m in bands]
    s.mesh("bands", [(planar_uv(join(bands)), "dark stone")])
    s.place("bands")


def pavement():
    """Squares of 3 m, each a quarter turn and some slabs away from its neighbours in the texture: joints meet, and no
    pattern of stains repeats."""
    rs = np.random.RandomState(21)
    parts = []
    for x in np.arange(-7.5, 7.5, 3.0):
        for z in np.arange(Z_FAR - 3, Z_NEAR + 6, 3.0):
            q = quad((x, 0, z + 3), (x + 3, 0, z + 3), (x + 3, 0, z), (x, 0, z))
            corner = np.array([[0, 0], [3, 0], [3, -3], [0, -3]], float)
            turn = np.roll(corner, rs.randint(4), axis=0)
            parts.append(q.with_uv(turn + 0.75 * rs.randint(0, 4, 2)))
    return join(parts)


def vault(s):
    """Coffered vault, twelve coffers around, with oculi eight coffers wide and a rib between each two."""
    arc = 2 * HALF_ARC * RADIUS
    s.mesh("coffers", [(ap.coffer_ring(RADIUS, arc, 12), "plaster")])
    s.mesh("coffers beside an oculus", [(ap.coffer_ring(RADIUS, arc, 12, skip=8), "plaster")])
    s.mesh("oculus", [(ap.oculus_patch(RADIUS, 4 * arc / 12, 3.0, OCULUS, RADIUS + 0.30), "plaster")])
    s.mesh("rib", [(ap.vault_rib(RADIUS, HALF_ARC), "limestone")])
    s.mesh("tie rod", [(ap.rod(2 * AXIS - 0.3, 0.022), "iron")])
    z = Z_NEAR - 0.5
    while z > Z_FAR:
        beside = any(abs(z - o) < 3 for o in OCULI)
        s.place("coffers beside an oculus" if beside else "coffers", (0, AXLE, z))
        z -= 1
    for o in OCULI:
        s.place("oculus", (0, AXLE, o))
        s.place("rib", (0, AXLE, o + 3))
    s.place("rib", (0, AXLE, OCULI[-1] - 3))
    for z in RODS:
        s.place("tie rod", (0, ROD, z))


def ends(s):
    """Far wall with steps, arch and round window; near wall with the portal; ends of the aisles."""
    half, top = AXIS + 0.3, 9.5
    r, spring = 1.9, 3.5   # the far arch
    wide, low = 3.2, 2.6   # the portal
    split = 6.2
    far = [ap.arch_panel(2 * half, 0, spring, split, r, 0.6, 40).moved(translate(0, 0, -0.3))]
    portal = [ap.arch_panel(2 * half, 0, low, split, wide, 0.6, 40).moved(translate(0, 0, -0.3))]
    c, hw, hole = 7.45, 1.25, 0.78
    panel = ap.round_hole_panel(hw, hw, hole, 0.6).moved(translate(0, c, 0))
    rest = [quad((a, b, 0), (a2, b, 0), (a2, b2, 0), (a, b2, 0)) for a, b, a2, b2 in
            ((-half, c + hw, half, top), (-half, split, -hw, c + hw), (hw, split, half, c + hw))]
    s.mesh("end wall", [(planar_uv(join(far + [panel] + rest)), "ashlar")])
    s.mesh("portal wall", [(planar_uv(join(portal + [panel] + rest)), "ashlar")])

    def ring(radius, at):
        return [ap.archivolt(radius, 0.36, 0.07, 0.0, 48).moved(translate(0, at, 0)),
                ap.keystone(radius, 0.36, 0.07, 0.0).moved(translate(0, at, 0))]
    s.mesh("end arch", [(join(ring(r, spring)), "limestone")])
    s.mesh("portal arch", [(join(ring(wide, low)), "limestone")])
    rings = join([lathe([(hole + 0.28, 0), (hole + 0.28, 0.05), (hole + 0.2, 0.07), (hole + 0.12, 0.03), (hole, 0.05),
                         (hole, 0)], 56).moved(translate(0, c, 0) @ rotate("x", 90))])
    s.mesh("end mouldings", [(rings, "limestone")])
    imposts = [box((k * r - 0.36, spring - 0.22, -0.65), (k * r + 0.36, spring, 0.10)) for k in (-1, 1)]
    imposts += [box((lo, DAIS - 0.01, -0.63), (lo + 0.38, spring - 0.215, 0.05)) for lo in (r - 0.02, -r - 0.36)]
    s.mesh("imposts", [(join(imposts), "limestone")])
    tracery = join([box((-0.04, -hole, -0.36), (0.04, hole, -0.26)), box((-hole, -0.04, -0.35), (hole, 0.04, -0.27)),
                    lathe([(0.34, -0.055), (0.41, -0.055), (0.41, 0.055), (0.34, 0.055), (0.34, -0.055)], 40).moved(
                        translate(0, 0, -0.31) @ rotate("x", 90))])
    s.mesh("tracery", [(tracery.moved(translate(0, c, 0)), "limestone")])
    for z, yaw in ((Z_FAR, 0.0), (Z_NEAR, 180.0)):
        for part in ("end mouldings", "tracery"):
            s.place(part, (0, 0, z), yaw)
    for part in ("end wall", "end arch", "imposts"):
        s.place(part, (0, 0, Z_FAR))
    for part in ("portal wall", "portal arch"):
        s.place(part, (0, 0, Z_NEAR), 180.0)
    # steps up to the dais, which runs on through the arch
    rise, tread, count = DAIS / 4, 0.36, 4
    front = Z_FAR + 1.6
    steps = []
    for k in range(count):
        z = front + tread * (count - 1 - k)
        steps.append(box((-AXIS + 0.42, rise * k, z - tread - 0.02), (AXIS - 0.42, rise * (k + 1), z), "-y -z"))
    steps.append(box((-AXIS + 0.42, 0, Z_FAR - 0.7), (AXIS - 0.42, DAIS, front - tread), "-y -z +z"))
    s.mesh("steps", [(join(steps), "limestone")])
    s.place("steps")
    # ends of the aisles on both storeys
    lo, hi = AXIS - 0.35, OUTER + 0.3
    blank = quad((lo, 0, 0), (hi, 0, 0), (hi, CEILING2 + 0.3, 0), (lo, CEILING2 + 0.3, 0))
    s.mesh("aisle end", [(planar_uv(blank), "plaster")])
    openings = [ap.arch_panel(hi - lo, 0, 2.5, GALLERY, 1.3, 0.5).moved(translate(0, 0, -0.25)),
                ap.arch_panel(hi - lo, GALLERY, SPRING2 - 0.5, CEILING2 + 0.3, 1.1, 0.5).moved(translate(0, 0, -0.25))]
    s.mesh("aisle portal", [(join(openings), "ashlar")])
    for x in (0, -lo - hi):
        s.place("aisle end", (x, 0, Z_FAR - 0.01))  # behind the end wall's plane, which it overlaps
    for x in (-1, 1):
        s.place("aisle portal", (x * (lo + hi) / 2, 0, Z_NEAR + 0.01), 180.0)


def impluvium(s):
    """The sunken basin along the hall's axis: dark water in a stone curb."""
    x, z0, z1 = POOL
    curb, high = 0.30, 0.13
    profile = [(0.0, -0.02), (0.0, high - 0.02), (0.015, high), (curb - 0.02, high), (curb, high - 0.02), (curb, 0.0)]
    corner = np.array([(-x, z0), (x, z0), (x, z1), (-x, z1), (-x, z0)], float)
    out = np.array([(-1, 1), (1, 1), (1, -1), (-1, -1), (-1, 1)], float)
    sides = []
    for k in range(4):
        a, b = corner[k], corner[k + 1]
        length = np.linalg.norm(b - a)
        n, gap = max(1, int(round(length / 1.2))), 0.002 / length
        for j in range(n):   # single stones, a joint of 4 mm between them, mitred at the corners
            t0, t1 = j / n + gap * (j > 0), (j + 1) / n - gap * (j < n - 1)
            ends = []
            for t, o in ((t0, out[k]), (t1, out[k + 1])):
                base = a + (b - a) * t
                straight = np.array([0.0, out[k][1]]) if k % 2 == 0 else np.array([out[k][0], 0.0])
                o = o if t in (0.0, 1.0) else straight
                ends.append([(base[0] + o[0] * w, h, base[1] + o[1] * w) for w, h in profile])
            for q in range(len(profile) - 1):
                m = quad(ends[0][q], ends[1][q], ends[1][q + 1], ends[0][q + 1])
                sides.append(m)
    s.mesh("curb", [(planar_uv(join(sides)), "limestone")])
    s.place("curb")
    s.mesh("water", [(garden.ripples(-x, x, z1, z0, 24, 90).moved(translate(0, 0.06, 0)), "water")])
    s.place("water")


def furnish(s):
    """Banners in the beams, rugs over the rail, lamps, orange trees, urns, benches, the bowl."""
    banner = [ap.hanging(1.4, 3.6, k) for k in (1, 2)]
    s.mesh("saffron banner", [(banner[0], "cloth saffron")])
    s.mesh("madder banner", [(banner[1], "cloth madder")])
    s.mesh("linen banner", [(banner[0], "cloth linen")])
    s.mesh("banner rod", [(ap.rod(1.6, 0.02), "wood")])
    for name, x, z in (("saffron banner", -2.35, 0.0), ("linen banner", -1.55, -6.0), ("madder banner", 2.45, -6.0)):
        s.place(name, (x, ROD - 0.03, z))
        s.place("banner rod", (x, ROD - 0.02, z))
    s.mesh("indigo rug", [(ap.rail_cloth(1.1, 1.5, 5), "cloth indigo")])
    s.mesh("indigo towel", [(ap.rail_cloth(0.75, 0.11, 6, 0.155, 0.09, 30, 24), "cloth indigo")])
    s.place("indigo rug", (AXIS, GALLERY + 1.0, -2.25), -90.0)
    s.place("indigo towel", (-POOL[0] - 0.15, 0.134, -0.9), -90.0)
    brass, globe = ap.globe_lamp(0.16)
    s.mesh("globe lamp", [(brass, "brass"), (globe, "opal")])
    for x in (-1, 1):
        for i in range(0 if x < 0 else 4, BAYS, 2):
            s.place("globe lamp", (x * (AXIS + OUTER) / 2, 2.95, bays()[i]))
    brass, glass, flame = ap.lantern_parts(0.20, 1.35)
    s.mesh("glass lamp", [(brass, "brass"), (glass, "glass"), (flame, "flame")])
    s.place("glass lamp", (AXIS, SPRING + 1.2 - 1.35, bays()[2]))
    s.mesh("urn", [(ap.urn(), "terracotta")])
    s.mesh("bowl", [(ap.bowl(0.50), "brass")])
    s.mesh("bench", [(ap.bench(), "wood")])
    s.mesh("pedestal", [(ap.pedestal(0.66, 0.32), "limestone")])
    s.place("pedestal", (-1.75, 0, 2.3))
    s.place("bowl", (-1.75, 0.66, 2.3), scale=(1, 0.66, 1))
    s.place("urn", (3.05, 0, 1.2), 40.0, scale=1.0)
    s.place("urn", (2.72, 0, 1.62), 10.0, scale=0.66)
    s.place("bench", (6.6, 0, -1.5), 90.0)
    s.place("bench", (-6.6, 0, -4.5), 90.0)
    s.mesh("vine", [(garden.vine(2.2, 1.7, 22, 1150, 3), "leaves")])
    for x, z, yaw in ((-1, -3.75, 90.0), (-1, -9.75, 90.0), (1, -8.25, -90.0)):
        s.place("vine", (x * AXIS, GALLERY + 1.0, z), yaw)
    s.mesh("fallen orange", [(sphere(0.038, 16, 10), "orange")])
    for x, z in ((-2.72, -5.35), (-2.45, -5.9), (2.62, -2.35), (2.35, -2.75), (2.78, -1.9), (-1.22, 1.1), (-1.16, 1.2)):
        s.place("fallen orange", (x, 0.038 + 0.13 * (abs(x) < 1.3), z), 77.0 * x)
    garden.orange_trees(s, ((-3.1, -6.0, 0, 1.1), (-3.1, -12.0, 130, 1.1), (3.1, -3.0, 250, 1.05),
                            (2.75, -15.0, 70, 1.0), (-2.75, -15.0, 200, 1.0)))


# Mixes of the scene's light (the panel LIGHT MIX).
PRESETS = ("day = | evening = sun: mute; sky: ev=-1.8 color=0.5,0.65,1.2; opal: ev=4 color=1,0.85,0.62; flame: ev=3 | "
           "morning = sun: ev=-0.4 color=1,0.55,0.28; sky: ev=-0.6 color=0.85,0.92,1.1")


def main():
    s = Scene("atrium")
    materials(s)
    arcade(s)
    aisles(s)
    vault(s)
    ends(s)
    garden.terrace(s, DAIS, Z_FAR - 0.65, Z_FAR - 8, 9.0, "balustrade")
    impluvium(s)
    furnish(s)
    hdr(s.folder + "/sky.hdr", textures.sky(256, SUN))
    s.sun("sun", -SUN, (1.0, 0.87, 0.69), 6.8)
    eye = 1.65
    s.camera("main", (1.25, eye, 8.6), (-0.9, eye, -12), yfov=45.0)
    s.camera("gallery", (-3.9, GALLERY + eye, 3.75), (1.9, 5.4, -9), yfov=50.0)
    s.camera("bowl", (-0.3, 1.6, 4.3), (-1.8, 0.85, 2.2), yfov=34.0)
    env = {"file": "sky.hdr", "scale": 1.1}
    s.extras = {"environment": env}
    s.write("The face of the program: late-morning sun through oculi on worn stone, its bounce in the shade under the "
            "gallery, cloth that glows through, cool sky light, small caustics of a brass bowl and a glass lamp. Also "
            "the size of a real job: instances, textures, normal maps, an environment, a sun and lamps.",
            {"film.ev": 0.15, "film.tone_curve": "neutral", "relight.presets": PRESETS, "environment": env})


if __name__ == "__main__":
    main()
