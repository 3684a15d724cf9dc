"""Directional albedos of the GGX reflection lobe, integrated here: the tables that node trees look up.

Independent of the renderer's own tables (renderer/upload/bsdf_table.cpp) in code and resolution.
"""
import itertools

import numpy as np

MU, ROUGH = 64, 33   # columns: sqrt of the cosine; rows: roughness 0 to 1
CLOSURE_IOR = 1.5    # of the Fresnel curve in Blender's closure


def cosines():
    return np.maximum(np.linspace(0, 1, MU) ** 2, 1e-4)


def roughnesses():
    return np.linspace(0, 1, ROUGH)


def _lambda(cosine, alpha):
    c2 = cosine * cosine
    return 0.5 * (np.sqrt(1 + alpha * alpha * (1 - c2) / np.maximum(c2, 1e-30)) - 1)


def schlick(cosine):
    return (1 - np.clip(cosine, 0, 1)) ** 5


def closure_curve(cosine, ior=CLOSURE_IOR):
    """Transition of Blender's Principled closure from the colour at normal incidence (0) to white (1)."""
    cosine = np.clip(cosine, 0, 1)
    t = np.sqrt(1 - (1 - cosine * cosine) / ior ** 2)
    p, q = (ior * cosine - t) / (ior * cosine + t), (cosine - ior * t) / (cosine + ior * t)
    f0 = ((ior - 1) / (ior + 1)) ** 2
    return (0.5 * (p * p + q * q) - f0) / (1 - f0)


def lobe_row(mu, alpha, n=48):
    """Albedo of the lobe seen at cosine mu: with F = 1, F = Schlick's weight, F = the closure's curve; then, with masking
    and shadowing taken as independent (Blender's plain GGX), with F = 1 and F = the closure's curve."""
    if alpha < 1e-4:
        return np.array([1, schlick(mu), closure_curve(mu), 1, closure_curve(mu)])
    u = (np.arange(n) + 0.5) / n
    u, v = np.meshgrid(u, u, indexing="ij")
    side = np.sqrt(1 - mu * mu)
    w = np.array([alpha * side, 0, mu]) / np.hypot(alpha * side, mu)
    phi, z = 2 * np.pi * u, (1 - v) * (1 + w[2]) - w[2]   # visible normals: a cap about w
    s = np.sqrt(np.clip(1 - z * z, 0, 1))
    h = np.stack([alpha * (s * np.cos(phi) + w[0]), alpha * s * np.sin(phi), np.maximum(z + w[2], 1e-12)], -1)
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    cosine = side * h[..., 0] + mu * h[..., 2]
    out = 2 * cosine * h[..., 2] - mu
    lambda_out = _lambda(np.maximum(out, 1e-9), alpha)
    g = np.where(out > 0, (1 + _lambda(mu, alpha)) / (1 + _lambda(mu, alpha) + lambda_out), 0)
    alone = np.where(out > 0, 1 / (1 + lambda_out), 0)
    f = closure_curve(cosine)
    return np.array([g.mean(), (g * schlick(cosine)).mean(), (g * f).mean(), alone.mean(), (alone * f).mean()])


_lobes = []


def lobes():
    """(ROUGH, MU, 5): lobe_row on the grid."""
    if not _lobes:
        _lobes.append(np.array([[lobe_row(mu, r * r) for mu in cosines()] for r in roughnesses()]))
    return _lobes[0]


def average(values):
    """Cosine-weighted average over the hemisphere of rows (..., MU)."""
    x = np.linspace(0, 1, 2001)   # sqrt of the cosine: 2 mu dmu = 4 x^3 dx
    at = np.linspace(0, 1, MU)
    rows = values.reshape(-1, MU)
    return np.array([np.trapz(4 * x ** 3 * np.interp(x, at, row), x) for row in rows]).reshape(values.shape[:-1])


def exit_term(cosine):
    """Dependence of Principled's diffuse term at roughness 0 on either direction, relative to Lambert."""
    return 1 - 0.5 * schlick(cosine)


def fit_positive(columns, wanted):
    """Least squares with weights >= 0 (Cycles takes no others), over all subsets of the few columns."""
    best = (np.inf, None)
    for n in range(1, columns.shape[1] + 1):
        for chosen in itertools.combinations(range(columns.shape[1]), n):
            x = np.linalg.lstsq(columns[:, chosen], wanted, rcond=None)[0]
            error = ((columns[:, chosen] @ x - wanted) ** 2).sum()
            if (x >= 0).all() and error < best[0]:
                best = (error, np.zeros(columns.shape[1]))
                best[1][list(chosen)] = x
    return best[1]


def coat(f0, f90):
    """Transmittance of a coat, 1 - E: (ROUGH, MU), for one channel; and weights (ROUGH, 2) of 1 and exit_term
    that sum, as functions of the other direction's cosine, to (1 - E) / (1 - E_avg); and E over the albedo of Blender's
    plain GGX closure of the same colour (ROUGH, MU)."""
    t = lobes()
    e1 = t[:, :, 0]
    e1_average = average(e1)[:, None]
    mean = f0 + (f90 - f0) / 21
    complement = mean * mean * e1_average / (1 - mean * (1 - e1_average))
    through = 1 - f0 * (e1 - t[:, :, 1]) - f90 * t[:, :, 1] - complement * (1 - e1)
    relative = through / average(through)[:, None]
    x = np.linspace(0.01, 1, 300)
    weight = x ** 1.5   # squared: area times cosine, x^3 dx
    basis = np.stack([np.ones_like(x), exit_term(x * x)], 1)
    at = np.sqrt(cosines())
    fit = np.array([fit_positive(basis * weight[:, None], np.interp(x, at, row) * weight) for row in relative])
    # Exact on average, so the energy is right despite the error of the fit.
    means = np.trapz(4 * x[:, None] ** 3 * basis, x, axis=0)
    closure = f90 * (t[:, :, 4] + f0 / f90 * (t[:, :, 3] - t[:, :, 4]))
    return through, fit / (fit @ means)[:, None], (1 - through) / closure
