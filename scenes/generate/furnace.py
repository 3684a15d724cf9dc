"""Analytic scenes: the value of every pixel is known, so a test needs no reference picture.

`furnace-open` and `furnace-closed`: everything has albedo 1, everything sees radiance 1, so every pixel is 1.
`furnace-disk` and `furnace-sphere`: a Lambertian floor under one light whose irradiance has a closed form.
"""

import numpy as np

from gltf import Mesh, Scene
from shapes import box, disk, quad, sphere

ROUGHNESS = (0, 0.25, 0.5, 0.75, 1)
STEP = 2.4


def white_spheres(scene):
    """Four rows (front view, top to bottom: metal, coated dielectric, solid glass, the rest), five columns."""
    ball = sphere(1.0, 128, 64)
    rows = []
    for r in ROUGHNESS:
        tag = f"{r:g}"
        rows.append([
            scene.material("metal " + tag, (1, 1, 1), rough=r, metal=1),
            scene.material("dielectric " + tag, (1, 1, 1), rough=r),
            scene.material("glass " + tag, (1, 1, 1), glass=r)])
    last = [
        scene.material("lambert", (1, 1, 1), lambert=True),
        scene.material("half metal", (1, 1, 1), rough=0.5, metal=0.5),
        scene.material("thin glass", (1, 1, 1), glass=0, thin=True),
        scene.material("thin frosted glass", (1, 1, 1), glass=0.5, thin=True),
        scene.material("cloth", (1, 1, 1), lambert=True, through=0.5, through_color=(1, 1, 1))]
    for column in range(5):
        for row, material in enumerate(rows[column] + [last[column]]):
            scene.mesh(material, [(ball, material)])
            scene.place(material, (STEP * (column - 2), STEP * (1.5 - row), 0))


def furnace_open():
    scene = Scene("furnace-open")
    white_spheres(scene)
    scene.camera("main", (0, 0, 12), (0, 0, 0), ortho=(STEP * 2.5, STEP * 2), up=(0, 1, 0))
    scene.extras = {"environment": {"radiance": [1, 1, 1]}}
    scene.write("White furnace, open: spheres of albedo 1 (rows metal, dielectric, glass for roughness 0 to 1; last row "
                "Lambert, half metal, thin glass, frosted thin glass, cloth) under radiance 1 from everywhere. Every "
                "pixel is 1.", {"environment": {"radiance": [1, 1, 1]}})


def furnace_closed():
    scene = Scene("furnace-closed")
    scene.material("wall", (0.5, 0.5, 0.5), lambert=True, emit=(0.5, 0.5, 0.5))
    walls = box((-8, -7, -5), (8, 7, 14)).flipped()
    scene.mesh("box", [(walls, "wall")])
    scene.place("box")
    white_spheres(scene)
    scene.camera("main", (0, 0, 12), (0, 0, 0), yfov=2 * np.degrees(np.arctan(STEP * 2.3 / 12)))
    scene.write("White furnace, closed: a box whose Lambertian walls emit 1/2 and reflect 1/2, so that radiance is 1 "
                "everywhere, around the spheres of furnace-open. Every pixel is 1.")


def floor(scene):
    scene.material("floor", (0.5, 0.5, 0.5), lambert=True)
    scene.mesh("floor", [(quad((-20, 0, 20), (20, 0, 20), (20, 0, -20), (-20, 0, -20)), "floor")])
    scene.place("floor")
    # looks vertically down from below the light, without shading it; the picture's right is +x, its top -z
    scene.camera("main", (0, 0.5, 0), (0, 0, 0), ortho=(4, 4), up=(0, 0, -1))


def furnace_disk():
    scene = Scene("furnace-disk")
    floor(scene)
    scene.material("light", (0, 0, 0), lambert=True, emit=(1, 0.5, 0.25), strength=10)
    scene.mesh("disk", [(disk(1.0, 256, up=False), "light")])
    scene.place("disk", (0, 2, 0))
    scene.write("A disk light (radius 1, radiance (10, 5, 2.5), facing down) 2 m above a Lambertian floor of albedo 1/2; "
                "orthographic, 8 m x 8 m about the axis. At distance d from the axis the floor's irradiance is "
                "E = pi L/2 (1 - (h^2 + d^2 - r^2) / sqrt((h^2 + d^2 + r^2)^2 - 4 d^2 r^2)), its radiance E/(2 pi).")


def furnace_sphere():
    scene = Scene("furnace-sphere")
    floor(scene)
    scene.material("light", (0, 0, 0), lambert=True, emit=(1, 0.5, 0.25), strength=10)
    ball = sphere(1.0, 128, 64)
    # a convex body's mean shadow is a quarter of its surface: match the sphere's, 4 pi
    a, b, c = (ball.p[ball.t[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    ball = Mesh(ball.p * np.sqrt(4 * np.pi / area), ball.n, ball.uv, ball.t)
    scene.mesh("sphere", [(ball, "light")])
    scene.place("sphere", (0, 2.5, 0))
    scene.write("A sphere light (radius 1, radiance (10, 5, 2.5)) centred 2.5 m above a Lambertian floor of albedo 1/2; "
                "orthographic, 8 m x 8 m about the foot. At distance d from it the floor's irradiance is "
                "E = pi L r^2 h / (h^2 + d^2)^(3/2), its radiance E/(2 pi).")


if __name__ == "__main__":
    furnace_open()
    furnace_closed()
    furnace_disk()
    furnace_sphere()
