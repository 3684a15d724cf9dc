"""The Cornell box as measured, and the same box with glass and polished metal (`glass`).

One unit of the measurement (a millimetre) is stored as a centimetre, so the box is 5.5 m wide: a room to fly about in.
"""
import numpy as np

import spectra
from gltf import Scene
from gltf import join
from shapes import lathe, quad, sphere

LIGHT = (213, 343, 227, 332)  # x0, x1, z0, z1


def point(x, y, z):
    """From the measurement's frame (x to the left, z away) to glTF's: centred, Y up, the camera looking down -Z."""
    return (2.78 - x / 100, y / 100, -z / 100)


def face(*corners):
    return quad(*(point(*c) for c in corners))


def room(scene):
    for name, spectrum in (("white", spectra.WHITE), ("green", spectra.GREEN), ("red", spectra.RED)):
        scene.material(name, spectra.reflectance(spectrum), lambert=True)
    scene.material("light", (0.78, 0.78, 0.78), lambert=True, emit=spectra.radiance(spectra.LIGHT) / 25, strength=25)
    x0, x1, z0, z1 = LIGHT
    top = 548.8
    outer = [(0, top, 0), (556.0, top, 0), (556.0, top, 559.2), (0, top, 559.2)]
    inner = [(x0, top, z0), (x1, top, z0), (x1, top, z1), (x0, top, z1)]
    ceiling = [face(outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]) for i in range(4)]
    floor = face((0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2), (552.8, 0, 0))
    back = face((549.6, 0, 559.2), (0, 0, 559.2), (0, top, 559.2), (556, top, 559.2))
    scene.mesh("room", [(join([floor, back] + ceiling), "white")])
    scene.mesh("right wall", [(face((0, 0, 559.2), (0, 0, 0), (0, top, 0), (0, top, 559.2)), "green")])
    scene.mesh("left wall", [(face((552.8, 0, 0), (549.6, 0, 559.2), (556, top, 559.2), (556, top, 0)), "red")])
    # set into the hole of the ceiling, facing down; its back is never visible
    scene.mesh("lamp", [(face(*inner), "light")])
    for name in ("room", "right wall", "left wall", "lamp"):
        scene.place(name)
    scene.camera("main", point(278, 273, -800), point(278, 273, 0), yfov=2 * np.degrees(np.arctan(12.5 / 35)), aspect=1)


def block(corners, height):
    """A block on the floor: corners clockwise seen from above in the measurement's frame."""
    sides = []
    for (xa, za), (xb, zb) in zip(corners, corners[1:] + corners[:1]):
        sides.append(face((xa, 0, za), (xb, 0, zb), (xb, height, zb), (xa, height, za)))
    return join(sides + [face(*((x, height, z) for x, z in corners))])


def cornell():
    scene = Scene("cornell")
    room(scene)
    scene.mesh("short block", [(block([(130, 65), (82, 225), (240, 272), (290, 114)], 165.0), "white")])
    scene.mesh("tall block", [(block([(423, 247), (265, 296), (314, 456), (472, 406)], 330.0), "white")])
    scene.place("short block")
    scene.place("tall block")
    scene.write("The Cornell box: measured dimensions (1 mm as 1 cm) and measured spectra as linear Rec.709. Lambertian "
                "only: colour bleeding, soft shadows, the first picture to be right.", {"film.ev": 1.0})


def glass():
    scene = Scene("glass")
    room(scene)
    scene.material("glass", (1, 1, 1), glass=0, ior=1.5)
    scene.material("steel", (0.77, 0.77, 0.78), rough=0, metal=1)
    scene.material("gold", (1.0, 0.78, 0.34), rough=0, metal=1)
    ball = sphere(1.0, 192, 96)
    scene.mesh("glass sphere", [(ball, "glass")])
    scene.mesh("metal sphere", [(ball, "steel")])
    r0, r1, h, e = 0.80, 0.85, 0.34, 0.012
    ring = lathe([(r0, 0.002), (r1, 0.002), (r1, h - e), (r1 - e, h), (r0 + e, h), (r0, h - e), (r0, 0.002)], 192)
    scene.mesh("ring", [(ring, "gold")])
    scene.place("metal sphere", point(392, 102, 372), scale=1.02)
    scene.place("glass sphere", point(158, 92, 258), scale=0.92)
    scene.place("ring", point(345, 0, 150))
    scene.write("The Cornell box with a solid glass sphere, a polished metal sphere and a polished ring on the floor: "
                "caustics, their mirror images, and light through refraction (specular chains).", {"film.ev": 1.0})


if __name__ == "__main__":
    cornell()
    glass()
