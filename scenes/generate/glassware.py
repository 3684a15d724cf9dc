"""Vessels of clear glass with water in them, for light to be focused by; metres, standing on y = 0.

Where two bodies touch there is one surface between them, with the ratio of their indices of refraction: glass and air
1.5, water and air 1.333, glass and water 1.5 / 1.333 = 1.125 (front towards the water). So a path meets each interface
once, in the right order, and no two bodies overlap.
"""
import numpy as np

from gltf import Mesh, join
from shapes import deformed, facing, grid

GLASS, WATER = 1.5, 1.333


def materials(s):
    """"glass", "water" and "glass in water" in the scene `s`."""
    s.material("glass", (1, 1, 1), glass=0, ior=GLASS)
    s.material("water", (1, 1, 1), glass=0, ior=WATER)
    s.material("glass in water", (1, 1, 1), glass=0, ior=round(GLASS / WATER, 6))


def spline(points, dense=2000, level=True):
    """A natural cubic spline through (radius, height) points by their distances: dense points and unit tangents. level:
    the first point lies on the axis, and the curve crosses it horizontally."""
    c = np.asarray(points, float)
    skip = len(c) - 1 if level else 0
    if level:   # with its mirror image
        c = np.concatenate([c[:0:-1] * (-1, 1), c])
    t = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(c, axis=0), axis=1))])
    h = np.diff(t)
    n = len(c)
    a, b = np.eye(n), np.zeros((n, 2))
    for i in range(1, n - 1):
        a[i, i - 1:i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        b[i] = 6 * ((c[i + 1] - c[i]) / h[i] - (c[i] - c[i - 1]) / h[i - 1])
    m = np.linalg.solve(a, b)
    s = np.linspace(t[skip], t[-1], dense)
    i = np.clip(np.searchsorted(t, s, side="right") - 1, 0, n - 2)
    u, v, k = (s - t[i])[:, None], (t[i + 1] - s)[:, None], h[i][:, None]
    p = (m[i] * v ** 3 + m[i + 1] * u ** 3) / (6 * k) + (c[i] / k - m[i] * k / 6) * v + (c[i + 1] / k - m[i + 1] * k / 6) * u
    d = (m[i + 1] * u ** 2 - m[i] * v ** 2) / (2 * k) + (c[i + 1] - c[i]) / k - (m[i + 1] - m[i]) * k / 6
    if level:
        p[0, 0], d[0, 1] = 0, 0
    return p, d / np.linalg.norm(d, axis=1, keepdims=True)


def thinned(p, d, turn=6.5, most=0.010):
    """Those of dense points of a curve that are needed: a step turns by `turn` degrees or is `most` metres long."""
    keep, angle, length = [0], 0.0, 0.0
    for i in range(1, len(p)):
        angle += np.degrees(np.arccos(np.clip(d[i] @ d[i - 1], -1, 1)))
        length += np.linalg.norm(p[i] - p[i - 1])
        if angle >= turn or length >= most or i == len(p) - 1:
            keep.append(i)
            angle = length = 0.0
    return p[keep], d[keep]


def turned(p, d, segments):
    """Turns (radius, height) points with their tangents about Y; outside is to the right of the curve."""
    phi = 2 * np.pi * np.arange(segments + 1) / segments
    s, c = np.sin(phi), np.cos(phi)
    s[-1], c[-1] = s[0], c[0]
    one = np.ones_like(s)
    points = np.stack([p[:, :1] * s, p[:, 1:] * one, p[:, :1] * c], 2)
    normals = np.stack([d[:, 1:] * s, -d[:, :1] * one, d[:, 1:] * c], 2)
    m = grid(points, normals.reshape(-1, 3))
    # triangles at the axis have no area: their normals say how they are wound all the same
    return facing(Mesh(m.p, m.n, None, m.t))


def lip(a, da, b):
    """Half a circle from the end of the outer wall, with its tangent, to that of the inner one."""
    middle, out = (a + b) / 2, (a - b) / 2
    up = np.array([-out[1], out[0]])
    up = up if up @ da > 0 else -up
    t = np.linspace(0, np.pi, 9)[:, None]
    return (middle + out * np.cos(t) + up * np.sin(t))[1:-1], (-out * np.sin(t) + up * np.cos(t))[1:-1] / np.linalg.norm(out)


def fluted(mesh, count, deep, low, high):
    """`count` shallow flutes, `deep` metres to either side of the wall, fading out at heights `low` and `high`."""
    def f(q):
        r, phi = np.hypot(q[:, 0], q[:, 2]), np.arctan2(q[:, 0], q[:, 2])
        t = np.clip((q[:, 1] - low) / (high - low), 0, 1)
        a = deep * 16 * t * t * (1 - t) ** 2
        m = 1 + a * np.cos(count * phi) / np.maximum(r, 1e-6)
        return np.stack([q[:, 0] * m, q[:, 1], q[:, 2] * m], 1)
    return deformed(mesh, f)


def vessel(outer, inner, level, segments, flutes=None):
    """[(Mesh, material)] of a vessel between two profiles from the axis up, filled to `level` (None: empty). flutes:
    what `fluted` takes, of the outer wall."""
    gap = 0.0003   # above what it stands on: it touches that nowhere, so light leaves it through its foot
    p, d = spline(outer)
    foot = p[:, 1].min() - gap
    q, e = spline(inner)
    p, q = p - (0, foot), q - (0, foot)
    p, d = thinned(p, d)
    over, along = lip(p[-1], d[-1], q[-1])
    wall = turned(np.concatenate([p, over, q[-1:]]), np.concatenate([d, along, -e[-1:]]), segments)
    if flutes:
        wall = fluted(wall, *flutes)
    if level is None:
        a, b = thinned(q, e)
        return [(join([wall, turned(a[::-1], -b[::-1], segments)]), "glass")]
    rise, reach = 0.0013, 0.0012   # of the water at the wall
    k = int(np.argmin(np.where(np.arange(len(q)) > len(q) // 8, abs(q[:, 1] - level - rise), np.inf)))
    wet, dry = thinned(q[:k + 1], e[:k + 1]), thinned(q[k:], e[k:])
    off = np.concatenate([np.array([0, 0.3, 0.7, 1.2, 1.8, 2.6, 3.6, 5.0, 7.5]) / 1000,
                          np.linspace(0.012, q[k, 0], max(3, int(q[k, 0] / 0.008)))])
    r, h = q[k, 0] - off, q[k, 1] - rise * (1 - np.exp(-off / reach))
    slope = np.stack([-np.ones_like(off), -rise / reach * np.exp(-off / reach)], 1)
    slope[-1, 1] = 0
    surface = turned(np.stack([r, h], 1), slope / np.linalg.norm(slope, axis=1, keepdims=True), segments)
    return [(join([wall, turned(dry[0][::-1], -dry[1][::-1], segments)]), "glass"),
            (turned(wet[0][::-1], -wet[1][::-1], segments), "glass in water"), (surface, "water")]


def carafe(level):
    """A water carafe, 26 cm high, of 1.1 litres."""
    outer = [(0, 0.0045), (0.020, 0.0036), (0.034, 0.0008), (0.0425, 0.0012), (0.0500, 0.0090), (0.0570, 0.036),
             (0.0600, 0.068), (0.0560, 0.102), (0.0435, 0.137), (0.0305, 0.168), (0.0245, 0.200), (0.0255, 0.230),
             (0.0325, 0.258)]
    inner = [(0, 0.0120), (0.020, 0.0113), (0.034, 0.0106), (0.0435, 0.0145), (0.0502, 0.0240), (0.0546, 0.040),
             (0.0575, 0.068), (0.0533, 0.1015), (0.0409, 0.135), (0.0280, 0.167), (0.0221, 0.200), (0.0230, 0.2305),
             (0.0302, 0.2585)]
    return vessel(outer, inner, level, 96, (8, 0.00035, 0.02, 0.15))


def tumbler(level=None):
    """A drinking glass, 9.5 cm high, with a heavy foot."""
    outer = [(0, 0.0022), (0.012, 0.0020), (0.022, 0.0008), (0.0275, 0.0003), (0.0309, 0.0026), (0.0326, 0.012),
             (0.0340, 0.035), (0.0356, 0.065), (0.0373, 0.0945)]
    inner = [(0, 0.0140), (0.012, 0.0139), (0.021, 0.0143), (0.0275, 0.0172), (0.0305, 0.0240), (0.0319, 0.036),
             (0.0337, 0.065), (0.0355, 0.0945)]
    return vessel(outer, inner, level, 72, (8, 0.0003, 0.006, 0.070))
