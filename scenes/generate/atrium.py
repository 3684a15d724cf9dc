"""The atrium: the program's default scene. A vaulted hall, seven bays of three metres, arcaded on two storeys.

x to the right, y up, the hall runs from z = +9 (portal, open to the sky) to z = -12 (apse). The sun comes from the right
and the far end, high: through three oculi in the vault onto the pavement, through the gallery's windows into the gallery.
"""
import numpy as np

import atrium_parts as ap
import textures
from gltf import Scene, hdr, join
from shapes import box, lathe, planar_uv, quad, rotate, scale, sphere, translate

BAY, BAYS = 3.0, 7
Z_NEAR, Z_FAR = 9.0, -12.0
AXIS, OUTER = 4.0, 7.2            # arcade's axis, inner face of the outer wall
SPRING, CEILING = 3.3, 4.75       # lower arcade springs, aisle's ceiling
GALLERY = 5.1                     # gallery's floor
SPRING2, CEILING2 = 7.55, 9.0     # upper arcade springs, gallery's ceiling
VAULT, RADIUS = 9.4, 4.0          # the vault's axis height and radius
WALL, WALL2 = 0.6, 0.45           # arcade walls' thickness below and above
OCULI, OCULUS = (-9.0, -3.0, 3.0), 1.7
DAIS = 0.6
SUN = np.array([0.355, 1.40, -0.68])   # towards the sun


def materials(s):
    f = s.folder
    maps = {"floor": textures.floor().save(f, "floor", rough_size=512),
            "ashlar": textures.ashlar().save(f, "ashlar", normal_size=512, rough_size=512),
            "limestone": textures.limestone().save(f, "limestone"),
            "plaster": textures.plaster().save(f, "plaster"),
            "wood": textures.wood().save(f, "wood")}
    size = {"floor": 3.0, "ashlar": 3.0, "limestone": 1.5, "plaster": 2.5, "wood": 1.2}
    for name, m in maps.items():
        s.material(name, (1, 1, 1), rough=1.0, maps=m, metres=size[name])
    s.material("dark stone", (0.16, 0.15, 0.145), rough=0.62, maps=maps["limestone"], metres=1.5)
    s.material("ochre plaster", (0.97, 0.80, 0.58), rough=1.0, maps=maps["plaster"], metres=2.5)
    s.material("red plaster", (0.72, 0.32, 0.20), rough=1.0, maps=maps["plaster"], metres=2.5)
    textures.png(f + "/cloth_color.png", textures.to_srgb(textures.cloth().color))
    weave = {"color": "cloth_color.png", "through": "cloth_color.png"}
    s.material("cloth saffron", (0.74, 0.36, 0.07), lambert=True, double=True, maps=weave, through=0.45,
               through_color=(0.95, 0.50, 0.10))
    s.material("cloth madder", (0.52, 0.11, 0.07), lambert=True, double=True, maps=weave, through=0.4,
               through_color=(0.80, 0.16, 0.08))
    s.material("cloth linen", (0.66, 0.58, 0.45), lambert=True, double=True, maps=weave, through=0.45,
               through_color=(0.90, 0.76, 0.54))
    s.material("cloth indigo", (0.11, 0.17, 0.36), lambert=True, double=True, maps=weave, through=0.35,
               through_color=(0.16, 0.28, 0.62))
    s.material("brass", (0.91, 0.71, 0.36), rough=0.22, metal=1)
    s.material("iron", (0.20, 0.19, 0.18), rough=0.55, metal=1)
    s.material("terracotta", (0.42, 0.19, 0.10), rough=0.75)
    s.material("glass", (1, 1, 1), glass=0, ior=1.5)
    s.material("flame", (0, 0, 0), lambert=True, emit=(1.0, 0.60, 0.27), strength=16)
    s.material("opal", (0.6, 0.58, 0.52), lambert=True, emit=(1.0, 0.64, 0.32), strength=5)
    s.material("earth", (0.38, 0.31, 0.22), lambert=True)


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
    s.mesh("small column", [(ap.column(h2, 0.125, 14), "limestone")])
    s.mesh("small capital", [(join([ap.leaves(0.125, h2 - 0.62 * 0.125 / 0.27, around=40, along=5),
                                    ap.abacus(0.19, h2 - 0.08, h2 + 0.001)]), "limestone")])
    lower = ap.arch_panel(BAY, 0, 0, CEILING + 0.4 - SPRING, 1.2, WALL).moved(translate(0, SPRING, 0))
    s.mesh("arch", [(lower, "ashlar")])
    ring = [ap.archivolt(1.2, 0.26, 0.05, k * WALL / 2, side=k) for k in (1, -1)]
    ring += [ap.keystone(1.2, 0.26, 0.05, k * WALL / 2, side=k) for k in (1, -1)]
    s.mesh("archivolt", [(join(ring).moved(translate(0, SPRING, 0)), "limestone")])
    upper = ap.arch_panel(BAY / 2, 0, 0, VAULT + 0.3 - SPRING2, 0.58, WALL2, 20).moved(translate(0, SPRING2, 0))
    s.mesh("small arch", [(upper, "ashlar")])
    small = join([ap.archivolt(0.58, 0.13, 0.03, k * WALL2 / 2, 16, side=k) for k in (1, -1)])
    s.mesh("small archivolt", [(small.moved(translate(0, SPRING2, 0)), "limestone")])
    s.mesh("balustrade", [(ap.balustrade(BAY / 2, 6), "limestone")])
    course = [(0, 0), (0.05, 0.03), (0.05, 0.10), (0.10, 0.20), (0.16, 0.24), (0.20, 0.27), (0.20, 0.34), (0, 0.36)]
    s.mesh("string course", [(ap.cornice(BAY, course, 0.15).moved(translate(0, CEILING, WALL / 2)), "limestone")])
    crown = [(0, 0), (0.06, 0.04), (0.06, 0.14), (0.14, 0.24), (0.24, 0.30), (0.30, 0.33), (0.30, 0.42), (0, 0.46)]
    s.mesh("cornice", [(ap.cornice(BAY, crown, 0.2).moved(translate(0, VAULT - 0.46, WALL2 / 2)), "limestone")])
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
            for part in ("arch", "archivolt", "string course", "cornice"):
                s.place(part, (x * AXIS, 0, z), yaw)
            for half in (-BAY / 4, BAY / 4):
                s.place("small arch", (x * AXIS, 0, z + half), yaw)
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
    s.mesh("gallery floor", [(box((-BAY / 2, 0.061, -width / 2 - 0.29), (BAY / 2, GALLERY - CEILING, width / 2 + 0.3),
                                  "-y +x -x"), "floor")])
    # lower outer wall: plaster above a dado, a pilaster at every column
    wall = quad((-BAY / 2, 0, 0), (BAY / 2, 0, 0), (BAY / 2, GALLERY, 0), (-BAY / 2, GALLERY, 0))
    dado = join([box((-BAY / 2, 0, 0), (BAY / 2, 0.95, 0.05), "-z -y +x -x"),
                 ap.cornice(BAY, [(0.05, 0), (0.075, 0.01), (0.09, 0.05), (0.09, 0.08), (0, 0.095)]).moved(
                     translate(0, 0.95, 0)),
                 box((-BAY / 2, 0, 0.05), (BAY / 2, 0.18, 0.085), "-z -y +x -x")])
    pilaster = join([box((-0.24, 0, 0), (0.24, CEILING - 0.40, 0.13), "-z -y"),
                     box((-0.29, 0, 0), (0.29, 0.32, 0.18), "-z -y"),
                     box((-0.29, CEILING - 0.62, 0), (0.29, CEILING - 0.52, 0.18), "-z"),
                     box((-0.33, CEILING - 0.52, 0), (0.33, CEILING - 0.40, 0.22), "-z")])
    s.mesh("aisle wall", [(planar_uv(wall), "ochre plaster")])
    s.mesh("dado", [(dado, "ashlar")])
    s.mesh("pilaster", [(pilaster, "limestone")])
    # upper outer wall: a window a bay, 1.1 m wide, reveal 0.5 m deep
    sill, head = 1.0, 2.35
    window = ap.arch_panel(1.7, sill, head, CEILING2 + 0.3 - GALLERY, 0.55, 0.5, 20).moved(translate(0, 0, -0.25))
    flanks = [quad((a, sill, 0), (b, sill, 0), (b, CEILING2 + 0.3 - GALLERY, 0), (a, CEILING2 + 0.3 - GALLERY, 0))
              for a, b in ((-BAY / 2, -0.85), (0.85, BAY / 2))]
    below = quad((-BAY / 2, -0.1, 0), (BAY / 2, -0.1, 0), (BAY / 2, sill, 0), (-BAY / 2, sill, 0))
    shelf = box((-0.70, sill - 0.07, -0.55), (0.70, sill, 0.06))
    bars = [box((-0.018, sill, -0.32), (0.018, head + 0.55, -0.28), "-y +y")]
    bars += [box((-0.55, y - 0.018, -0.315), (0.55, y + 0.018, -0.285), "+x -x") for y in (1.45, 1.9, 2.35)]
    s.mesh("window wall", [(planar_uv(join([window, below] + flanks)), "plaster")])
    s.mesh("window shelf", [(join([shelf]), "limestone")])
    s.mesh("window bars", [(join(bars), "iron")])
    s.mesh("window ring", [(join([ap.archivolt(0.55, 0.14, 0.035, 0.0, 24)]).moved(translate(0, head, 0)),
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
    # pavement: slabs, with a pair of dark bands along each arcade
    edges = [-OUTER - 0.3, -3.24, -3.0, -2.88, -2.82, 2.82, 2.88, 3.0, 3.24, OUTER + 0.3]
    strips = [quad((a, 0, Z_NEAR + 4), (b, 0, Z_NEAR + 4), (b, 0, Z_FAR - 3.2), (a, 0, Z_FAR - 3.2))
              for a, b in zip(edges[:-1], edges[1:])]
    s.mesh("pavement", [(planar_uv(join(strips[0::2])), "floor"), (planar_uv(join(strips[1::2])), "dark stone")])
    s.place("pavement")


def vault(s):
    """Coffered barrel, twelve coffers around, with three oculi four coffers wide."""
    s.mesh("coffers", [(ap.coffer_ring(RADIUS, 12), "plaster")])
    s.mesh("coffers beside an oculus", [(ap.coffer_ring(RADIUS, 12, skip=4), "plaster")])
    s.mesh("oculus", [(ap.oculus_patch(RADIUS, 2 * np.pi * RADIUS / 12, 2.0, OCULUS, RADIUS + 0.55), "plaster")])
    s.mesh("tie rod", [(ap.rod(2 * AXIS - 0.3, 0.022), "iron")])
    z = Z_NEAR - 0.5
    while z > Z_FAR:
        beside = any(abs(z - o) < 2 for o in OCULI)
        s.place("coffers beside an oculus" if beside else "coffers", (0, VAULT, z))
        z -= 1
    for o in OCULI:
        s.place("oculus", (0, VAULT, o))
    for i in range(1, BAYS):
        s.place("tie rod", (0, VAULT - 0.62, Z_NEAR - BAY * i))


def ends(s):
    """Far wall with steps, arch, apse and round window; near wall with the portal; ends of the aisles."""
    half, top = AXIS + 0.3, VAULT + RADIUS + 0.6
    r, spring = 2.3, 4.4
    wide, low = 3.2, 3.9   # the portal's half width and springing
    wall = [ap.arch_panel(2 * half, 0, spring, 7.6, r, 0.6, 40).moved(translate(0, 0, -0.3))]
    portal = [ap.arch_panel(2 * half, 0, low, 7.6, wide, 0.6, 40).moved(translate(0, 0, -0.3))]
    hole = 1.25
    c, hw = 10.3, 2.0
    panel = ap.round_hole_panel(hw, hw, hole, 0.6).moved(translate(0, c, 0))
    rest = [quad((a, b, 0), (a2, b, 0), (a2, b2, 0), (a, b2, 0)) for a, b, a2, b2 in
            ((-half, 7.6, half, c - hw), (-half, c + hw, half, top), (-half, c - hw, -hw, c + hw),
             (hw, c - hw, half, c + hw))]
    s.mesh("end wall", [(planar_uv(join(wall + [panel] + rest)), "ashlar")])
    s.mesh("portal wall", [(planar_uv(join(portal + [panel] + rest)), "ashlar")])

    def ring(radius, at):
        return [ap.archivolt(radius, 0.36, 0.07, 0.0, 48).moved(translate(0, at, 0)),
                ap.keystone(radius, 0.36, 0.07, 0.0).moved(translate(0, at, 0))]
    s.mesh("end arch", [(join(ring(r, spring)), "limestone")])
    s.mesh("portal arch", [(join(ring(wide, low)), "limestone")])
    rings = join([lathe([(hole + 0.28, 0), (hole + 0.28, 0.05), (hole + 0.2, 0.07), (hole + 0.12, 0.03), (hole, 0.05),
                         (hole, 0)], 64).moved(translate(0, c, 0) @ rotate("x", 90))])
    s.mesh("end mouldings", [(rings, "limestone")])
    imposts = [box((k * r - 0.36, spring - 0.22, -0.65), (k * r + 0.36, spring, 0.10)) for k in (-1, 1)]
    s.mesh("imposts", [(join(imposts), "limestone")])
    tracery = join([box((-0.05, -hole, -0.36), (0.05, hole, -0.26)), box((-hole, -0.05, -0.35), (hole, 0.05, -0.27)),
                    lathe([(0.62, -0.05), (0.70, -0.05), (0.70, 0.05), (0.62, 0.05), (0.62, -0.05)], 48).moved(
                        translate(0, 0, -0.31) @ rotate("x", 90))])
    s.mesh("tracery", [(tracery.moved(translate(0, c, 0)), "limestone")])
    for z, yaw in ((Z_FAR, 0.0), (Z_NEAR, 180.0)):
        for part in ("end mouldings", "tracery"):
            s.place(part, (0, 0, z), yaw)
    for part in ("end wall", "end arch", "imposts"):
        s.place(part, (0, 0, Z_FAR))
    for part in ("portal wall", "portal arch"):
        s.place(part, (0, 0, Z_NEAR), 180.0)
    # the apse: half a drum under half a dome, behind the far arch
    depth = Z_FAR - 0.6
    drum = ap.drum(r, 0.0, spring, (12.0, 1.75, 4.0, 0.4)).moved(translate(0, 0, depth))
    bars = [box((-0.02, 1.75, -r - 0.22), (0.02, 4.0, -r - 0.18), "-y +y")]
    bars += [box((-0.48, y - 0.018, -r - 0.215), (0.48, y + 0.018, -r - 0.185), "+x -x") for y in (2.5, 3.25)]
    s.mesh("apse window bars", [(join(bars).moved(translate(0, 0, depth)), "iron")])
    s.place("apse window bars")
    a = np.radians(np.linspace(0, 90, 17))
    dome = lathe([(r * np.cos(v), spring + r * np.sin(v)) for v in a], 48, arc=180.0).flipped().moved(
        translate(0, 0, depth) @ rotate("y", 90))
    band = lathe([(r + 0.01, spring - 0.10), (r - 0.07, spring - 0.10), (r - 0.11, spring), (r - 0.07, spring + 0.05),
                  (r + 0.01, spring + 0.07)][::-1], 48, arc=180.0).moved(translate(0, 0, depth) @ rotate("y", 90))
    s.mesh("apse", [(drum, "red plaster"), (dome, "ochre plaster")])
    s.mesh("apse moulding", [(band, "limestone")])
    s.place("apse")
    s.place("apse moulding")
    # steps up to the dais, which runs on into the apse
    rise, tread, count = DAIS / 4, 0.34, 4
    front = Z_FAR + 1.0
    steps = []
    for k in range(count):
        z = front + tread * (count - 1 - k)
        steps.append(box((-AXIS + 0.42, rise * k, z - tread - 0.02), (AXIS - 0.42, rise * (k + 1), z), "-y -z"))
    steps.append(box((-AXIS + 0.42, 0, Z_FAR - 3.1), (AXIS - 0.42, DAIS, front - tread), "-y -z +z"))
    s.mesh("steps", [(join(steps), "limestone")])
    s.place("steps")
    # ends of the aisles on both storeys
    lo, hi = AXIS - 0.35, OUTER + 0.3
    blank = quad((lo, 0, 0), (hi, 0, 0), (hi, CEILING2 + 0.3, 0), (lo, CEILING2 + 0.3, 0))
    s.mesh("aisle end", [(planar_uv(blank), "plaster")])
    openings = [ap.arch_panel(hi - lo, 0, 2.9, GALLERY, 1.3, 0.5).moved(translate(0, 0, -0.25)),
                ap.arch_panel(hi - lo, GALLERY, SPRING2 - 0.4, CEILING2 + 0.3, 1.2, 0.5).moved(translate(0, 0, -0.25))]
    s.mesh("aisle portal", [(join(openings), "ashlar")])
    for x in (0, -lo - hi):
        s.place("aisle end", (x, 0, Z_FAR))
    for x in (-1, 1):
        s.place("aisle portal", (x * (lo + hi) / 2, 0, Z_NEAR), 180.0)
    s.mesh("earth", [(box((-60, -0.45, -60), (60, -0.05, 60), "-y +x -x +z -z"), "earth")])
    s.place("earth")


def furnish(s):
    """Banners in the beams, rugs over the rail, lamps, urns, a bench, the bowl."""
    banner = [ap.hanging(1.4, 4.2, k) for k in (1, 2)]
    s.mesh("saffron banner", [(banner[0], "cloth saffron")])
    s.mesh("madder banner", [(banner[1], "cloth madder")])
    s.mesh("linen banner", [(banner[0], "cloth linen")])
    s.mesh("banner rod", [(ap.rod(1.6, 0.02), "wood")])
    for name, x, z in (("saffron banner", -2.2, -6.0), ("madder banner", 2.0, -6.0), ("linen banner", -2.65, 0.0),
                       ("saffron banner", 2.2, 3.0)):
        s.place(name, (x, VAULT - 0.70, z))
        s.place("banner rod", (x, VAULT - 0.69, z))
    s.mesh("indigo rug", [(ap.rail_cloth(1.1, 1.5, 5), "cloth indigo")])
    s.mesh("saffron rug", [(ap.rail_cloth(1.1, 1.7, 6), "cloth saffron")])
    s.place("indigo rug", (-AXIS, GALLERY + 1.0, -2.25), 90.0)
    s.place("saffron rug", (AXIS, GALLERY + 1.0, -5.25), -90.0)
    brass, globe = ap.globe_lamp()
    s.mesh("globe lamp", [(brass, "brass"), (globe, "opal")])
    for x in (-1, 1):
        for i in range(BAYS):
            if i % 2 == (x > 0):
                s.place("globe lamp", (x * (AXIS + OUTER) / 2, 3.7, bays()[i]))
    s.place("globe lamp", (0, 4.3, Z_FAR - 0.9), scale=1.6)
    brass, glass, flame = ap.lantern_parts(0.17, 1.72)
    s.mesh("glass lamp", [(brass, "brass"), (glass, "glass"), (flame, "flame")])
    s.mesh("urn", [(ap.urn(), "terracotta")])
    s.mesh("bowl", [(ap.bowl(), "brass")])
    s.mesh("bench", [(ap.bench(), "wood")])
    s.mesh("pedestal", [(ap.pedestal(0.66), "limestone")])
    s.place("pedestal", (-2.25, 0, 3.1))
    s.place("bowl", (-2.25, 0.66, 3.1), scale=1.15)
    s.place("urn", (3.05, 0, 1.2), 40.0, scale=1.0)
    s.place("urn", (3.28, 0, 0.62), 10.0, scale=0.72)
    s.place("urn", (0, DAIS, Z_FAR - 1.2), scale=1.5)
    s.place("bench", (6.6, 0, -1.5), 90.0)
    s.place("bench", (-6.6, 0, -4.5), 90.0)
    s.place("glass lamp", (AXIS, SPRING + 1.2 - 1.70, bays()[2]))


def main():
    s = Scene("atrium")
    materials(s)
    arcade(s)
    aisles(s)
    vault(s)
    ends(s)
    furnish(s)
    hdr(s.folder + "/sky.hdr", textures.sky(256, SUN))
    s.sun("sun", -SUN, (1.0, 0.89, 0.74), 19.0)
    eye = 1.65
    s.camera("main", (1.3, eye, 9.1), (-0.2, eye, -12), yfov=46.0)
    s.camera("gallery", (-4.4, GALLERY + eye, 3.75), (1.6, 5.0, -8), yfov=50.0)
    s.camera("bowl", (-1.1, 1.6, 4.9), (-2.3, 0.74, 3.0), yfov=34.0)
    env = {"file": "sky.hdr", "scale": 1.5}
    s.extras = {"environment": env}
    s.write("The face of the program: sun through oculi on worn stone, its bounce under the gallery, cloth that glows "
            "through, cool sky light, small caustics of a brass bowl and a glass lamp. Also the size of a real job: "
            "instances, textures, normal maps, an environment, a sun and lamps.", {"film.ev": 0.5, "environment": env})


if __name__ == "__main__":
    main()
