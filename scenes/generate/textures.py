"""Procedural surfaces for the atrium: every function returns tileable arrays, painted in linear light, stored as sRGB.

A `Surface` holds colour (h, w, 3, linear) and height in metres (h, w); `save` writes the colour and normal maps. All
are 1024 x 1024, so that a renderer can keep them in one texture array each for colours and for normals.
"""
import os

import numpy as np

from gltf import png


class Surface:
    def __init__(self, color, height, metres):
        self.color, self.height, self.metres = color, height, metres

    def save(self, folder, name, normal=True):
        """Writes NAME_color.png and, with `normal`, NAME_normal.png; returns the map table."""
        png(os.path.join(folder, name + "_color.png"), to_srgb(self.color))
        maps = {"color": name + "_color.png"}
        if normal:
            h = self.height
            step = np.array(self.metres)[::-1] / h.shape
            dv = (np.roll(h, -1, 0) - np.roll(h, 1, 0)) / (2 * step[0])
            du = (np.roll(h, -1, 1) - np.roll(h, 1, 1)) / (2 * step[1])
            n = np.stack([-du, dv, np.ones_like(h)], 2)   # v runs down the picture, the tangent frame's y up
            n /= np.linalg.norm(n, axis=2, keepdims=True)
            png(os.path.join(folder, name + "_normal.png"), np.round(n * 127 + 128).clip(0, 255))
            maps["normal"] = name + "_normal.png"
        return maps


def to_srgb(c):
    c = np.clip(c, 0, 1)
    s = np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.power(np.maximum(c, 1e-9), 1 / 2.4) - 0.055)
    return np.round(s * 255)


def noise(shape, seed, exponent=1.0, low=1.0, high=1e9, stretch=(1.0, 1.0)):
    """Periodic Gaussian noise of unit deviation whose amplitude falls as frequency^-exponent between low and high
    cycles a picture; stretch > 1 draws it out along (rows, columns)."""
    white = np.random.RandomState(seed).standard_normal(shape)
    fy = np.fft.fftfreq(shape[0])[:, None] * shape[0] * stretch[0]
    fx = np.fft.fftfreq(shape[1])[None, :] * shape[1] * stretch[1]
    f = np.hypot(fy, fx)
    gain = np.where((f >= low) & (f <= high), np.maximum(f, 0.5) ** -exponent, 0)
    a = np.fft.ifft2(np.fft.fft2(white) * gain).real
    return (a - a.mean()) / a.std()


def smooth(a, lo, hi):
    t = np.clip((a - lo) / (hi - lo), 0, 1)
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    """Colours a to b by a scalar field t."""
    return np.asarray(a) * (1 - t[..., None]) + np.asarray(b) * t[..., None]


def rgb(*c):
    return np.array(c, float)


def stone_tone(shape, seed, light, dark, amount=1.0):
    """Limestone: clouds, bedding, fine grain and a few veins, as colour and as a scalar for height."""
    clouds = noise(shape, seed, 1.6, 2, 40)
    bedding = noise(shape, seed + 1, 1.3, 2, 120, (1.0, 4.0))
    grain = noise(shape, seed + 2, 0.4, 60, 260)
    t = 0.42 + amount * (0.13 * clouds + 0.07 * bedding + 0.045 * grain)
    color = mix(light, dark, np.clip(t, 0, 1))
    ridge = np.abs(noise(shape, seed + 3, 1.5, 2, 60))
    vein = (1 - smooth(ridge, 0.0, 0.05)) * smooth(noise(shape, seed + 4, 1.6, 2, 12), 0.2, 1.2)
    color = color * (1 - 0.18 * amount * vein[..., None] * rgb(0.7, 1.0, 1.25))
    return color, 0.6 * clouds + 0.5 * grain


def pits(shape, seed, threshold=2.1):
    """Small weathered holes, 0 to 1."""
    return smooth(noise(shape, seed, 0.7, 30, 160), threshold, threshold + 0.9)


def floor(n=1024):
    """Worn pavement, 3 m: 4 x 4 slabs of 75 cm with dark cabochons at their corners."""
    count, size = 4, n // 4
    y, x = np.mgrid[0:n, 0:n]
    # edges deviate by a millimetre or two, as in hand-laid floors
    wx = x + 0.9 * noise((n, n), 11, 1.5, 2, 30)
    wy = y + 0.9 * noise((n, n), 12, 1.5, 2, 30)
    cx, cy = np.floor(wx / size).astype(int) % count, np.floor(wy / size).astype(int) % count
    fx, fy = np.mod(wx / size, 1) - 0.5, np.mod(wy / size, 1) - 0.5
    rs = np.random.RandomState(7)
    tone, warm = rs.standard_normal((count, count)), rs.standard_normal((count, count))
    color, relief = stone_tone((n, n), 20, rgb(0.78, 0.72, 0.62), rgb(0.55, 0.485, 0.385))
    # each slab is cut from another part of the stone: shift the pattern per slab
    shift = rs.randint(0, n, (count, count, 2))
    sy, sx = (y + shift[cy, cx, 0]) % n, (x + shift[cy, cx, 1]) % n
    color, relief = color[sy, sx], relief[sy, sx]
    color = color * (1 + 0.085 * tone[cy, cx])[..., None] * (1 + 0.024 * warm[cy, cx][..., None] * rgb(1, 0, -1.2))
    corner = np.abs(np.abs(fx) - 0.5) + np.abs(np.abs(fy) - 0.5)   # 0 in the corners
    dark_color, _ = stone_tone((n, n), 40, rgb(0.17, 0.165, 0.155), rgb(0.08, 0.08, 0.082))
    inset = smooth(0.155 - corner, 0.0, 0.006)
    color = mix(color, dark_color, inset)
    joint = np.minimum(np.minimum(0.5 - np.abs(fx), 0.5 - np.abs(fy)), 9)
    joint = np.where(corner < 0.15, np.abs(0.155 - corner) * 0.7, joint)
    joint = np.minimum(joint, np.abs(0.155 - corner) * 0.7)
    joint = joint * 0.75   # metres from the nearest joint
    grout = 1 - smooth(joint, 0.0015, 0.0045)
    hole = pits((n, n), 31) * (1 - inset)
    dirt = np.exp(-joint / 0.03)
    color = color * (1 - 0.30 * dirt * smooth(noise((n, n), 33, 1.4, 2, 60), -0.6, 1.5))[..., None]
    stain = smooth(noise((n, n), 37, 1.5, 2, 30), 0.7, 2.0)
    stain = stain * (0.6 + 0.4 * smooth(noise((n, n), 38, 0.8, 20, 200), -1, 1))
    color = color * (1 - 0.16 * stain[..., None] * rgb(0.85, 1.0, 1.2))
    scuff = smooth(noise((n, n), 39, 0.9, 10, 250, (1.0, 3.0)), 1.6, 3.0)
    color = color * (1 - 0.10 * scuff)[..., None]
    color = mix(color, rgb(0.20, 0.165, 0.125), 0.85 * grout)
    color = mix(color, rgb(0.22, 0.18, 0.135), 0.7 * hole)
    height = 0.00025 * relief - 0.0028 * grout - 0.0022 * hole - 0.0018 * np.exp(-joint / 0.006) \
        + 0.0016 * noise((n, n), 34, 2.0, 1, 6)

    return Surface(color, height, (3.0, 3.0))


def ashlar(n=1024):
    """Dressed limestone blocks, 3 m: eight courses of 37.5 cm."""
    rows, row = 8, n // 8
    y, x = np.mgrid[0:n, 0:n]
    wx, wy = x + 1.0 * noise((n, n), 51, 1.5, 2, 40), y + 1.0 * noise((n, n), 52, 1.5, 2, 40)
    cy = np.floor(wy / row).astype(int) % rows
    rs = np.random.RandomState(9)
    edge_distance, cell = np.empty((n, n)), np.empty((n, n), int)
    for r in range(rows):
        cuts = np.sort((np.array([0.0, 0.26, 0.5, 0.77]) + (r % 2) * 0.125 + rs.uniform(-0.03, 0.03, 4)) % 1.0) * n
        here = cy == r
        px = np.mod(wx[here], n)
        d = np.abs(px[:, None] - cuts[None, :])
        edge_distance[here] = np.minimum(d, n - d).min(axis=1)
        cell[here] = r * 4 + np.searchsorted(cuts, px) % 4
    fy = np.mod(wy / row, 1)
    joint = np.minimum(edge_distance, np.minimum(fy, 1 - fy) * row) * 3.0 / n
    color, relief = stone_tone((n, n), 60, rgb(0.80, 0.735, 0.625), rgb(0.60, 0.525, 0.41))
    shift = rs.randint(0, n, (rows * 4, 2))
    sy, sx = (y + shift[cell, 0]) % n, (x + shift[cell, 1]) % n
    color, relief = color[sy, sx], relief[sy, sx]
    tone, warm = rs.standard_normal(rows * 4), rs.standard_normal(rows * 4)
    color = color * (1 + 0.075 * tone[cell])[..., None] * (1 + 0.024 * warm[cell][..., None] * rgb(1, 0, -1.2))
    grout = 1 - smooth(joint, 0.002, 0.006)
    hole = pits((n, n), 71, 1.9)
    color = mix(color, rgb(0.44, 0.375, 0.29), 0.8 * grout)
    color = mix(color, rgb(0.30, 0.24, 0.17), 0.65 * hole)
    streak = smooth(noise((n, n), 73, 1.2, 2, 90, (6.0, 1.0)), 0.5, 2.4)
    color = color * (1 - 0.10 * streak)[..., None]
    tooling = noise((n, n), 74, 0.5, 60, 240, (1.0, 2.5))
    height = 0.0006 * relief + 0.0003 * tooling - 0.003 * grout - 0.003 * hole - 0.002 * np.exp(-joint / 0.012)
    return Surface(color, height, (3.0, 3.0))


def limestone(n=1024):
    """Carved stone without joints, 2 m: columns and mouldings."""
    color, relief = stone_tone((n, n), 80, rgb(0.82, 0.765, 0.66), rgb(0.62, 0.545, 0.44), 0.9)
    hole = pits((n, n), 86, 2.3)
    color = mix(color, rgb(0.36, 0.30, 0.22), 0.6 * hole)
    height = 0.0003 * relief - 0.0015 * hole
    return Surface(color, height, (2.0, 2.0))


def plaster(n=1024):
    """Lime plaster, 3.6 m: trowel marks, faint clouds, a few hairline cracks."""
    clouds, trowel = noise((n, n), 90, 1.7, 1, 12), noise((n, n), 91, 1.2, 8, 90, (1.0, 1.7))
    fine = noise((n, n), 92, 0.4, 60, 200)
    color = rgb(0.80, 0.76, 0.69) * (1 + 0.035 * clouds + 0.02 * trowel + 0.012 * fine)[..., None]
    color = color * (1 + 0.012 * noise((n, n), 95, 1.6, 1, 10)[..., None] * rgb(1, 0, -1.5))
    crack = (1 - smooth(np.abs(noise((n, n), 93, 1.35, 2, 90)), 0.0, 0.025)) * \
        smooth(noise((n, n), 94, 1.6, 1, 8), 0.9, 1.9)
    color = color * (1 - 0.35 * crack)[..., None]
    height = 0.0011 * trowel + 0.0004 * fine * 0.4 + 0.002 * clouds - 0.0012 * crack
    return Surface(color, height, (3.6, 3.6))


def wood(n=1024):
    """Boards of weathered oak along v, 1.6 m: eight boards of 20 cm."""
    count, size = 8, n / 8
    y, x = np.mgrid[0:n, 0:n]
    board = np.floor(x / size).astype(int) % count
    rs = np.random.RandomState(13)
    offset, tone = rs.randint(0, n, count), rs.standard_normal(count)
    sy = (y + offset[board]) % n
    rings = noise((n, n), 100, 0.9, 6, 200, (14.0, 1.0))[sy, x]
    figure = noise((n, n), 101, 1.5, 2, 40, (7.0, 1.0))[sy, x]
    pores = smooth(noise((n, n), 102, 0.3, 40, 250, (10.0, 1.0))[sy, x], 1.1, 2.4)
    t = np.clip(0.5 + 0.16 * rings + 0.15 * figure, 0, 1)
    color = mix(rgb(0.42, 0.28, 0.165), rgb(0.22, 0.13, 0.07), t)
    color = color * (1 + 0.16 * tone[board])[..., None] * (1 - 0.45 * pores)[..., None]
    f = np.mod(x / size, 1)
    gap = np.minimum(f, 1 - f) * 0.2
    seam = 1 - smooth(gap, 0.001, 0.004)
    color = color * (1 - 0.8 * seam)[..., None]
    height = 0.0004 * rings - 0.0004 * pores - 0.004 * seam
    return Surface(color, height, (1.6, 1.6))


def cloth(n=1024):
    """A banner's weave and pattern as a grey to be tinted: u across 1.4 m, v down 4.2 m."""
    h, w = n, n
    y, x = np.mgrid[0:h, 0:w]
    u, v = (x + 0.5) / w, (y + 0.5) / h
    slub = 0.5 * noise((h, w), 110, 0.5, 4, 250, (1.0, 12.0)) + 0.5 * noise((h, w), 111, 0.5, 4, 250, (12.0, 1.0))
    thread = 0.25 * (np.cos(np.pi * x) + np.cos(np.pi * y))
    base = 1 - 0.045 * np.abs(slub) - 0.03 * thread + 0.03 * noise((h, w), 112, 1.6, 1, 8)
    edge = np.minimum(u, 1 - u) * 1.4
    band = smooth(edge, 0.060, 0.063) * (1 - smooth(edge, 0.105, 0.108))
    line = smooth(edge, 0.125, 0.127) * (1 - smooth(edge, 0.135, 0.137))
    for at, half in ((0.55, 0.05), (0.70, 0.012), (3.95, 0.05), (3.80, 0.012)):
        d = np.abs(v * 4.2 - at)
        band = np.maximum(band, 1 - smooth(d, half, half + 0.003))
    diamond = np.abs(u - 0.5) * 1.4 / 0.30 + np.abs(np.mod(v * 4.2 - 0.62, 1.04) - 0.52) / 0.42
    inside = (v * 4.2 > 0.75) & (v * 4.2 < 3.78)
    ring = smooth(diamond, 0.80, 0.82) * (1 - smooth(diamond, 0.93, 0.95)) + 1 - smooth(diamond, 0.30, 0.32)
    ring = ring * inside
    pattern = np.clip(band + line + ring, 0, 1)
    color = np.repeat(base[..., None], 3, 2) * mix(rgb(1, 1, 1), rgb(0.42, 0.20, 0.14), 0.9 * pattern)
    return Surface(color, np.zeros((h, w)), (1.4, 4.2))


def sky(width=256, sun=(0, 1, 0)):
    """Clear sky without the sun's disk, (h, w, 3) radiance in the scene's unit; black from 10 degrees below the
    horizon."""
    h = width // 2
    v, u = (np.arange(h) + 0.5) / h, (np.arange(width) + 0.5) / width
    theta, phi = np.pi * v[:, None], 2 * np.pi * (u[None, :] - 0.5)
    up = np.repeat(np.cos(theta), width, 1)
    d = np.stack([np.sin(theta) * np.cos(phi), up, np.sin(theta) * np.sin(phi)], 2)
    cosine = d @ (np.asarray(sun) / np.linalg.norm(sun))
    low = np.exp(-np.maximum(up, 0) / 0.22)
    color = mix(rgb(0.40, 0.66, 1.15), rgb(0.66, 0.80, 0.98), low)
    angle = np.arccos(np.clip(cosine, -1, 1))
    glow = 1.2 * np.exp(-angle / 0.18) + 0.6 * np.exp(-angle / 0.6)
    color = color * (0.86 + 0.14 * cosine ** 2)[..., None] + glow[..., None] * rgb(1.0, 0.94, 0.83)
    # the scene's ground hides lower directions: black there, so no light sample is wasted on them
    return color * (1 - smooth(-up, 0.08, 0.16))[..., None]
