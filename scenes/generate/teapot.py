"""Newell's teapot in a closed Cornell box with a glossy floor (`teapot`).

The box is the measured one at its true size, 55 cm, but twice as deep and closed, with the camera inside: every pixel shows
a surface, in any shape of picture. The teapot is Newell's of 1975 as it is known today: 32 bicubic patches, squashed to
three quarters of its height, with a bottom.
"""
import numpy as np

import spectra
from gltf import Scene, join
from shapes import bezier, quad, rotate, scale, translate

WIDTH, HEIGHT, DEPTH = 0.5528, 0.5488, 1.10
LAMP = (0.150, 0.120)            # the light's sides, x and z
LAMP_Z = -0.12

# ---- Newell's numbers: z is up, the spout points to +x, the pot stands on z = 0 --------------------------------------
# Turned parts as (radius, height) curves; a ring of four patches goes round each, quarter circles drawn by the handles
# 0.56 r (0.45 for the knob's 0.8). The lid's edge is 1.3 in Newell's table: 1.4 here, so that it closes the pot.
TURNED = {
    "rim": [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],
    "upper body": [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],
    "lower body": [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    "knob": [(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)],
    "lid": [(0.2, 2.7), (0.4, 2.55), (1.4, 2.55), (1.4, 2.4)],
    "bottom": [(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)]}
# Bent parts as the halves y <= 0: rows along the part, four (x, y, z) across it.
BENT = {
    "handle above": [[(-1.6, 0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0, 2.25)],
                     [(-2.3, 0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0, 2.25)],
                     [(-2.7, 0, 2.025), (-2.7, -0.3, 2.025), (-3.0, -0.3, 2.25), (-3.0, 0, 2.25)],
                     [(-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3.0, -0.3, 1.8), (-3.0, 0, 1.8)]],
    "handle below": [[(-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3.0, -0.3, 1.8), (-3.0, 0, 1.8)],
                     [(-2.7, 0, 1.575), (-2.7, -0.3, 1.575), (-3.0, -0.3, 1.35), (-3.0, 0, 1.35)],
                     [(-2.5, 0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0, 0.9375)],
                     [(-2.0, 0, 0.9), (-2.0, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0, 0.6)]],
    "spout": [[(1.7, 0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0, 0.6)],
              [(2.6, 0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0, 0.825)],
              [(2.3, 0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0, 2.025)],
              [(2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4)]],
    "lip": [[(2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4)],
            [(2.8, 0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0, 2.49375)],
            [(2.9, 0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0, 2.5125)],
            [(2.8, 0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0, 2.4)]]}


def turned(profile, quarter):
    """The 4 x 4 control points of one quarter of a turned part."""
    rows = []
    for r, z in profile:
        k = 0.45 if r == 0.8 else 0.56 * r
        rows.append([(r, 0, z), (r, k, z), (k, r, z), (0, r, z)])
    a = np.radians(90 * quarter)
    c, s = round(float(np.cos(a))), round(float(np.sin(a)))
    return np.array(rows, float) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], float)


def teapot(steps=14):
    """The pot about the middle of its foot, in Newell's units, glTF's axes: y up, the spout to +x."""
    patches = []
    for name, profile in TURNED.items():
        away = {"rim": lambda p: np.broadcast_to((0, 0, -9.0), p.shape) * (1, 1, 1),
                "bottom": lambda p: p * (0, 0, 0) + (0, 0, 3.0)}.get(name, lambda p: p * (0, 0, 1) - (0, 0, 0.4))
        patches += [bezier(turned(profile, q), steps, away) for q in range(4)]
    for name, half in BENT.items():
        c = np.array(half, float)
        for side in (1, -1):
            m = c * (1, side, 1)
            axis = (m[:, 0] + m[:, 3]) / 2        # the part's own line, at the rows of control points

            def away(p, axis=axis):
                t = np.linspace(0, 1, steps + 1)[:, None]
                b = np.hstack([(1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t * t, t ** 3])
                return np.repeat((b @ axis)[:, None], steps + 1, 1)
            patches.append(bezier(m, steps, away))
    m = join(patches)
    return m.moved(rotate("x", -90))


def room(s):
    w, h, d = WIDTH / 2, HEIGHT, DEPTH / 2
    lx, lz = LAMP[0] / 2, LAMP[1] / 2
    white, green, red = (spectra.reflectance(v) for v in (spectra.WHITE, spectra.GREEN, spectra.RED))
    s.material("white", white, lambert=True)
    s.material("green", green, lambert=True)
    s.material("red", red, lambert=True)
    s.material("floor", (0.21, 0.205, 0.195), rough=0.2, ior=1.8)
    s.material("glaze", (0.74, 0.72, 0.66), rough=0.38, double=True)
    s.material("light", (0.78, 0.78, 0.78), lambert=True, emit=(1.0, 0.80, 0.56), strength=22)
    outer = [(-w, h, -d), (w, h, -d), (w, h, d), (-w, h, d)]
    inner = [(-lx, h, LAMP_Z - lz), (lx, h, LAMP_Z - lz), (lx, h, LAMP_Z + lz), (-lx, h, LAMP_Z + lz)]
    ceiling = [quad(outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]) for i in range(4)]
    back = quad((-w, 0, -d), (w, 0, -d), (w, h, -d), (-w, h, -d))
    front = quad((w, 0, d), (-w, 0, d), (-w, h, d), (w, h, d))
    s.mesh("room", [(join(ceiling + [back, front]), "white")])
    s.mesh("floor", [(quad((-w, 0, d), (w, 0, d), (w, 0, -d), (-w, 0, -d)), "floor")])
    s.mesh("left wall", [(quad((-w, 0, d), (-w, 0, -d), (-w, h, -d), (-w, h, d)), "red")])
    s.mesh("right wall", [(quad((w, 0, -d), (w, 0, d), (w, h, d), (w, h, -d)), "green")])
    s.mesh("lamp", [(quad(*inner), "light")])
    for name in ("room", "floor", "left wall", "right wall", "lamp"):
        s.place(name)


def main():
    s = Scene("teapot")
    room(s)
    size = 0.053                 # metres a unit: the pot is 35 cm from handle to spout, 17 cm high
    s.mesh("teapot", [(teapot().moved(translate(0, -0.0001, 0) @ rotate("y", -28) @ scale(size)), "glaze")])
    s.place("teapot", (-0.010, 0, -0.17))
    s.camera("main", (0.0, 0.185, 0.47), (0.0, 0.185, -1.0), yfov=42.0)
    s.write("The Cornell box at its true size, closed, with Newell's teapot on a glossy floor: secondary and tertiary light "
            "on smooth curved surfaces, seen also in the blurred mirror of the floor.", {"film.ev": 1.05})


if __name__ == "__main__":
    main()
