"""Rooms: thick walls with openings, planked floors, skirtings, cornices, wainscots, windows, doors, radiators.

Each function returns a Mesh in metres. What stands on a surface is sunk into it by a millimetre where it is placed, and
members that cross differ in depth, so that no two faces share a plane.
"""
import numpy as np

from gltf import join
from shapes import box, chamfer, lathe, rotate, slab, translate


def shell(width, depth, height, thick=0.30, holes=None):
    """A closed room about the y axis, its floor at y = 0: {"-x", "+x", "-z", "+z", "floor", "ceiling"} -> Mesh. Walls reach
    into each other and into floor and ceiling, so that no corner lets light through.

    holes: {"-x": [(z0, z1, y0, y1)], "-z": [(x0, x1, y0, y1)], "ceiling": [(x0, x1, z0, z1)], ...}
    """
    w, d, t, holes = width / 2, depth / 2, thick, holes or {}
    out = {}
    for name, s in (("-x", -1), ("+x", 1)):
        x = sorted((s * w, s * (w + t)))
        out[name] = slab((x[0], -0.08, -d - 0.7 * t), (x[1], height + 0.08, d + 0.7 * t), "x", holes.get(name, ()))
    for name, s in (("-z", -1), ("+z", 1)):
        z = sorted((s * d, s * (d + t)))
        out[name] = slab((-w - 0.8 * t, -0.09, z[0]), (w + 0.8 * t, height + 0.09, z[1]), "z", holes.get(name, ()))
    out["floor"] = slab((-w - 1.1 * t, -0.30, -d - 1.1 * t), (w + 1.1 * t, 0, d + 1.1 * t), "y")
    out["ceiling"] = slab((-w - 1.2 * t, height, -d - 1.2 * t), (w + 1.2 * t, height + 0.25, d + 1.2 * t), "y",
                          holes.get("ceiling", ()))
    return out


def planks(width, depth, board=0.14, length=2.2, tones=4, seed=1, thick=0.02, gap=0.0015):
    """A boarded floor about the y axis, boards along z, their tops at y = `thick`: one Mesh a tone of wood."""
    rs = np.random.RandomState(seed)
    rows = int(round(width / board))
    board = width / rows
    parts = [[] for _ in range(tones)]
    for i in range(rows):
        x0, x1 = -width / 2 + i * board + gap / 2, -width / 2 + (i + 1) * board - gap / 2
        z = -depth / 2 - rs.uniform(0, length)
        while z < depth / 2:
            end = z + length * rs.uniform(0.8, 1.2)
            a, b = max(z, -depth / 2), min(end, depth / 2)
            tone = rs.randint(tones)
            if b - a > 0.02:
                parts[tone].append(chamfer((x0, -0.001, a + gap / 2), (x1, thick, b - gap / 2), 0.0012))
            z = end
    return [join(p) for p in parts if p]


def skirting(width, depth, height=0.11, thick=0.016, gaps=None):
    """Boards round the foot of a room's walls. gaps: {"-x": [(z0, z1)], "-z": [(x0, x1)], ...} leaves out doorways."""
    gaps, parts = gaps or {}, []
    for name in ("-x", "+x", "-z", "+z"):
        half = (depth / 2 - thick) if name[1] == "x" else width / 2
        runs, at = [], -half
        for a, b in sorted(gaps.get(name, ())):
            runs.append((at, a))
            at = b
        runs.append((at, half))
        side = -1 if name[0] == "-" else 1
        for a, b in runs:
            wall = side * (width / 2 if name[1] == "x" else depth / 2)
            lo, hi = (wall - side * thick, -0.001, a), (wall + side * 0.004, height, b)
            if name[1] == "z":
                lo, hi = (a, lo[1], lo[0]), (b, hi[1], hi[0])
            parts.append(chamfer(lo, hi, 0.004))
    return join(parts)


def cornice(width, depth, height):
    """The moulding between a room's walls and its ceiling, about the y axis."""
    w, d, parts = width / 2, depth / 2, []
    for at, yaw, length in (((0, 0, -d), 0, width), ((0, 0, d), 180, width), ((-w, 0, 0), 90, depth),
                            ((w, 0, 0), -90, depth)):
        crown = join([chamfer((-length / 2 - 0.01, height - 0.10, -0.004),
                              (length / 2 + 0.01, height - 0.055, 0.03), 0.008),
                      chamfer((-length / 2 - 0.01, height - 0.06, -0.004), (length / 2 + 0.01, height + 0.004, 0.075),
                              0.012)])
        if yaw in (90, -90):   # the mitres' faces must not lie in one plane
            crown = crown.moved(translate(0, 0.0015, 0.0015))
        parts.append(crown.moved(translate(*at) @ rotate("y", yaw)))
    return join(parts)


def wainscot(length, panels, height):
    """Panelling along x to a wall's lower `height`, centred, out in +z from the wall's face."""
    parts = [box((-length / 2, -0.001, -0.002), (length / 2, height, 0.010), "-x +x -z")]
    stile = 0.10
    step = length / panels
    for i in range(panels + 1):
        x = -length / 2 + i * step
        a, b = max(x - stile / 2, -length / 2), min(x + stile / 2, length / 2)
        parts.append(chamfer((a, 0.13, 0.0), (b, height - 0.001, 0.024), 0.004))
    for a, b in ((0.0, 0.16), (height - 0.13, height)):
        parts.append(chamfer((-length / 2 + 0.0005, a - 0.001, 0.001), (length / 2 - 0.0005, b, 0.0255), 0.004))
    parts.append(chamfer((-length / 2 + 0.001, -0.001, 0.002), (length / 2 - 0.001, 0.13, 0.036), 0.006))
    parts.append(chamfer((-length / 2 + 0.001, height - 0.006, -0.001), (length / 2 - 0.001, height + 0.022, 0.048),
                         0.008))
    return join(parts)


def line_walls(s, width, depth, height, door, dado, trim, panels):
    """Cornice and wainscots of a room whose only door is in the far wall, placed in the scene `s`, "ceiling" and "woodwork".
    door: x from, to; trim: what its mouldings take on either side; panels: left and right of it, on a side, on the near
    wall."""
    w, d = width / 2, depth / 2
    left, right = door[0] - trim + w, w - door[1] - trim
    s.mesh("cornice", [(cornice(width, depth, height), "ceiling")])
    s.place("cornice")
    for name, length, count in zip(("left", "right", "side", "near"), (left, right, depth - 0.10, width), panels):
        s.mesh(f"wainscot {name}", [(wainscot(length, count, dado), "woodwork")])
    s.place("wainscot left", (-w + left / 2, 0, -d))
    s.place("wainscot right", (w - right / 2, 0, -d))
    s.place("wainscot side", (-w, 0, 0), 90)
    s.place("wainscot side", (w, 0, 0), -90)
    s.place("wainscot near", (0, 0, d), 180)


def window(width, height, across=2, up=2, frame=0.06, bar=0.028, deep=0.06):
    """A casement in the x-y plane, its opening's lower left corner at the origin, `deep` about z = 0; no panes."""
    h = deep / 2
    parts = [chamfer((-0.005, -0.005, -h), (frame, height + 0.005, h), 0.004),
             chamfer((width - frame, -0.005, -h), (width + 0.005, height + 0.005, h), 0.004),
             chamfer((frame - 0.01, -0.005, -h + 0.002), (width - frame + 0.01, frame, h - 0.002), 0.004),
             chamfer((frame - 0.01, height - frame, -h + 0.002),
                     (width - frame + 0.01, height + 0.005, h - 0.002), 0.004)]
    for i in range(1, across):
        x = frame + (width - 2 * frame) * i / across
        wide = bar * (0.9 if across > 2 or i * 2 != across else 1.6)
        parts.append(chamfer((x - wide / 2, frame - 0.01, -h + 0.006), (x + wide / 2, height - frame + 0.01, h - 0.006),
                             0.004))
    for i in range(1, up):
        y = frame + (height - 2 * frame) * i / up
        parts.append(chamfer((frame - 0.01, y - bar / 2, -h + 0.012), (width - frame + 0.01, y + bar / 2, h - 0.012),
                             0.004))
    return join(parts)


def architrave(width, height, wide=0.08, thick=0.02):
    """The moulding round three sides of an opening in a wall's face (z = 0, out in +z), from the floor up; the opening's
    lower left corner at the origin."""
    return join([chamfer((-wide, -0.001, -0.004), (0, height, thick), 0.005),
                 chamfer((width, -0.001, -0.004), (width + wide, height, thick), 0.005),
                 chamfer((-wide - 0.008, height + 0.0005, -0.004), (width + wide + 0.008, height + wide, thick + 0.004),
                         0.005)])


def door(width, height, panels=((0.10, 0.42), (0.50, 0.93)), thick=0.04):
    """A panelled leaf in the x-y plane, lower left corner at the origin, faces about z = 0; and its knobs (leaf, knobs).
    panels: (from, to) as shares of the height, each two panels wide."""
    stile, h = 0.11, thick / 2
    parts = [chamfer((0, 0, -h), (stile, height, h), 0.003),
             chamfer((width - stile, 0, -h), (width, height, h), 0.003)]
    edges = [0.0] + [v * height for p in panels for v in p] + [height]
    for a, b in zip(edges[0::2], edges[1::2]):
        parts.append(chamfer((stile - 0.005, a, -h + 0.001), (width - stile + 0.005, b, h - 0.001), 0.003))
    mid = width / 2
    for a, b in panels:
        a, b = a * height, b * height
        parts.append(chamfer((mid - 0.05, a - 0.005, -h + 0.002), (mid + 0.05, b + 0.005, h - 0.002), 0.003))
        for x0, x1 in ((stile, mid - 0.05), (mid + 0.05, width - stile)):
            parts.append(box((x0 - 0.004, a - 0.004, -0.007), (x1 + 0.004, b + 0.004, 0.007)))
            parts.append(chamfer((x0 + 0.035, a + 0.035, -0.013), (x1 - 0.035, b - 0.035, 0.013), 0.006))
    knob = lathe([(0.026, 0.0), (0.026, 0.004), (0.010, 0.008), (0.009, 0.028), (0.022, 0.038), (0.027, 0.052),
                  (0.020, 0.064), (0.0, 0.068)], 24)
    knobs = [knob.moved(translate(width - 0.055, 0.98, s * (h - 0.001)) @ rotate("x", 90 * s)) for s in (1, -1)]
    return join(parts), join(knobs)


def radiator(length, height=0.6, sections=None):
    """A column radiator along x, its back at z = 0, its foot at y = 0; each section a rounded blade, with pipes."""
    n = sections or int(round(length / 0.06))
    step = length / n
    parts = []
    for i in range(n):
        x = -length / 2 + (i + 0.5) * step
        parts.append(chamfer((x - 0.42 * step, 0.09, 0.03), (x + 0.42 * step, height, 0.055), 0.010))
        parts.append(chamfer((x - 0.42 * step, 0.09, 0.105), (x + 0.42 * step, height, 0.13), 0.010))
        parts.append(chamfer((x - 0.30 * step, 0.115, 0.045), (x + 0.30 * step, height - 0.004, 0.115), 0.006))
    for y in (0.14, height - 0.06):
        parts.append(lathe([(0.021, -length / 2 + 0.01), (0.021, length / 2 - 0.01)], 10).moved(
            translate(0, y, 0.08) @ rotate("z", 90)))
    for x in (-length / 2 + 0.09, length / 2 - 0.09):
        parts.append(chamfer((x - 0.02, -0.001, 0.05), (x + 0.02, 0.13, 0.11), 0.004))
    pipe = lathe([(0.011, -0.001), (0.011, 0.145)], 10).moved(translate(length / 2 + 0.035, 0, 0.08))
    valve = lathe([(0.0, 0.120), (0.017, 0.120), (0.017, 0.168), (0.012, 0.172), (0.012, 0.215), (0, 0.219)], 12).moved(
        translate(length / 2 + 0.035, 0, 0.08))
    stub = lathe([(0.010, 0.0), (0.010, 0.05)], 8).moved(translate(length / 2 + 0.04, 0.14, 0.08) @ rotate("z", 90))
    return join(parts + [pipe, valve, stub])


def picture(width, height, frame=0.03, mat=0.07, deep=0.022):
    """(frame, mat, picture) hung on a wall's face z = 0, centred."""
    w, h = width / 2, height / 2
    bars = [chamfer((-w, -h, 0.002), (-w + frame, h, deep), 0.004),
            chamfer((w - frame, -h, 0.002), (w, h, deep), 0.004),
            chamfer((-w + frame - 0.004, -h + 0.0004, 0.002), (w - frame + 0.004, -h + frame, deep - 0.001), 0.004),
            chamfer((-w + frame - 0.004, h - frame, 0.002), (w - frame + 0.004, h - 0.0004, deep - 0.001), 0.004)]
    a, b = w - frame, h - frame
    return (join(bars), box((-a - 0.004, -b - 0.004, 0.003), (a + 0.004, b + 0.004, 0.008), "-z"),
            box((-a + mat, -b + mat, 0.0075), (a - mat, b - mat, 0.0095), "-z"))
