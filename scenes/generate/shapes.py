"""Shapes from which the scenes are built; each returns a gltf.Mesh. Metres, Y up, counter-clockwise front."""
import numpy as np

from gltf import Mesh, join


def translate(x, y, z):
    m = np.eye(4)
    m[:3, 3] = (x, y, z)
    return m


def scale(x, y=None, z=None):
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def rotate(axis, degrees):
    """Rotation about 'x', 'y' or 'z', counter-clockwise seen from the axis' tip."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    m = np.eye(4)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    return m


def quad(a, b, c, d, uv_origin=None):
    """Flat (or nearly flat) quadrilateral, counter-clockwise; uv in metres along a-b and across it."""
    p = np.array([a, b, c, d], float)
    n1, n2 = np.cross(p[1] - p[0], p[2] - p[0]), np.cross(p[2] - p[0], p[3] - p[0])
    n1, n2 = n1 / np.linalg.norm(n1), n2 / np.linalg.norm(n2)
    u = p[1] - p[0]
    u /= np.linalg.norm(u)
    v = np.cross(n1, u)
    uv = np.stack([(p - p[0]) @ u, -(p - p[0]) @ v], axis=1)
    if np.dot(n1, n2) > 1 - 1e-9:
        return Mesh(p, np.tile(n1, (4, 1)), uv, [[0, 1, 2], [0, 2, 3]])
    q = p[[0, 1, 2, 0, 2, 3]]
    return Mesh(q, np.repeat([n1, n2], 3, axis=0), uv[[0, 1, 2, 0, 2, 3]], [[0, 1, 2], [3, 4, 5]])


def planar_uv(mesh):
    """uv in metres from the dominant axis of each normal: x/z on floors, along the wall and height on walls."""
    a = np.abs(mesh.n)
    p = mesh.p
    horizontal = (a[:, 1] >= a[:, 0]) & (a[:, 1] >= a[:, 2])
    along_x = ~horizontal & (a[:, 2] > a[:, 0])
    u = np.where(horizontal | along_x, p[:, 0], -p[:, 2])
    v = np.where(horizontal, p[:, 2], -p[:, 1])
    return mesh.with_uv(np.stack([u, v], axis=1))


def box(lo, hi, skip=""):
    """Axis-aligned box, normals outwards, uv in metres. skip: faces left out, of '+x -x +y -y +z -z'."""
    (x0, y0, z0), (x1, y1, z1) = lo, hi
    faces = {
        "+x": ((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)),
        "-x": ((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
        "+y": ((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)),
        "-y": ((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
        "+z": ((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
        "-z": ((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
    }
    drop = skip.split()
    return planar_uv(join([quad(*f) for k, f in faces.items() if k not in drop]))


def grid(points, normals=None, uv=None, close=False):
    """Surface over an (h, w, 3) array; front where row direction x column direction points; smooth normals if given,
    else averaged from the faces."""
    p = np.asarray(points, float)
    h, w, _ = p.shape
    i, j = np.meshgrid(np.arange(h - 1), np.arange(w - 1), indexing="ij")
    a = (i * w + j).ravel()
    t = np.concatenate([np.stack([a, a + w, a + w + 1], 1), np.stack([a, a + w + 1, a + 1], 1)])
    flat = p.reshape(-1, 3)
    if normals is None:
        face = np.cross(flat[t[:, 1]] - flat[t[:, 0]], flat[t[:, 2]] - flat[t[:, 0]])
        n = np.zeros_like(flat)
        for k in range(3):
            np.add.at(n, t[:, k], face)
        n = n.reshape(h, w, 3)
        if close:
            n[:, 0] += n[:, -1]
            n[:, -1] = n[:, 0]
        normals = n.reshape(-1, 3)
    normals = np.asarray(normals, float).reshape(-1, 3)
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)
    return Mesh(flat, normals, uv, t)


def lathe(profile, segments=32, smooth=35.0, arc=360.0):
    """Turns (radius, height) points, bottom to top, about Y; outside is to the right of the profile going up.

    Edges sharper than `smooth` degrees stay sharp. uv in metres: around (at the largest radius) and along.
    """
    pts = np.asarray(profile, float)
    d = np.diff(pts, axis=0)
    length = np.linalg.norm(d, axis=1)
    keep = length > 1e-9
    seg_n = np.stack([d[:, 1], -d[:, 0]], axis=1) / np.maximum(length, 1e-12)[:, None]
    along = np.concatenate([[0], np.cumsum(length)])
    phi = np.radians(arc) * np.arange(segments + 1) / segments
    c, s = np.cos(phi), np.sin(phi)
    if arc == 360.0:
        c[-1], s[-1] = c[0], s[0]
    r_max = pts[:, 0].max()
    parts, cos_limit = [], np.cos(np.radians(smooth))
    for k in np.nonzero(keep)[0]:
        ends = []
        for end, other in ((k, k - 1), (k + 1, k + 1)):
            n = seg_n[k].copy()
            if 0 <= other < len(d) and keep[other] and np.dot(seg_n[k], seg_n[other]) > cos_limit:
                n = n + seg_n[other]
            if pts[end, 0] < 1e-9 and abs(seg_n[k][1]) > 0.9:
                n = np.array([0, np.sign(seg_n[k][1])])
            ends.append(n / np.linalg.norm(n))
        row_p, row_n, row_uv = [], [], []
        for (end, n) in zip((k, k + 1), ends):
            r, y = pts[end]
            row_p.append(np.stack([r * s, np.full_like(s, y), r * c], 1))
            row_n.append(np.stack([n[0] * s, np.full_like(s, n[1]), n[0] * c], 1))
            row_uv.append(np.stack([phi * r_max, np.full_like(s, -along[end])], 1))
        # rows go up, columns counter-clockwise from above: column x row points outwards, hence the flip
        m = grid(np.stack(row_p), np.stack(row_n), np.concatenate(row_uv))
        parts.append(Mesh(m.p, m.n, m.uv, m.t[:, ::-1]))
    return join(parts)


def sphere(radius=1.0, segments=64, rings=32):
    """Latitude-longitude sphere, exact normals."""
    th = np.pi * np.arange(rings + 1) / rings
    ph = 2 * np.pi * np.arange(segments + 1) / segments
    c, s = np.cos(ph), np.sin(ph)
    c[-1], s[-1] = c[0], s[0]
    st, ct = np.sin(th), np.cos(th)
    st[0] = st[-1] = 0
    n = np.stack([st[:, None] * s, np.repeat(ct[:, None], segments + 1, 1), st[:, None] * c], 2)
    uv = np.stack([np.tile(ph * radius, (rings + 1, 1)), np.repeat((th * radius)[:, None], segments + 1, 1)], 2)
    return grid(n * radius, n.reshape(-1, 3), uv.reshape(-1, 2))


def disk(radius, segments=64, up=True):
    """Disk in the plane y = 0 whose polygon has the area of the circle."""
    r = radius * np.sqrt(2 * np.pi / segments / np.sin(2 * np.pi / segments))
    a = 2 * np.pi * np.arange(segments) / segments
    p = np.concatenate([[[0, 0, 0]], np.stack([r * np.sin(a), 0 * a, r * np.cos(a)], 1)])
    i = np.arange(segments)
    t = np.stack([0 * i, 1 + i, 1 + (i + 1) % segments], 1)
    m = Mesh(p, np.tile([0, 1, 0], (len(p), 1)), p[:, [0, 2]], t)
    return m if up else m.flipped()


def sweep(profile, path, frames, smooth=35.0, uv_along=None):
    """Sweeps a 2D profile [(a, b)...] along points `path` with frames [(A, B)...]: point = path + a*A + b*B.

    Outside is to the right of the profile, seen with the path going away from the eye. Sharp edges stay sharp along
    the profile, smooth along the path.
    """
    pts, path = np.asarray(profile, float), np.asarray(path, float)
    A, B = np.asarray(frames[0], float), np.asarray(frames[1], float)
    d = np.diff(pts, axis=0)
    length = np.linalg.norm(d, axis=1)
    seg_n = np.stack([d[:, 1], -d[:, 0]], axis=1) / np.maximum(length, 1e-12)[:, None]
    across = np.concatenate([[0], np.cumsum(length)])
    if uv_along is None:
        uv_along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    cos_limit = np.cos(np.radians(smooth))
    parts = []
    for k in range(len(d)):
        if length[k] < 1e-9:
            continue
        rows = []
        for end, other in ((k, k - 1), (k + 1, k + 1)):
            n = seg_n[k]
            if 0 <= other < len(d) and length[other] > 1e-9 and np.dot(seg_n[k], seg_n[other]) > cos_limit:
                n = n + seg_n[other]
            p = path + pts[end, 0] * A + pts[end, 1] * B
            rows.append((p, n[0] * A + n[1] * B, np.stack([uv_along, np.full(len(path), across[end])], 1)))
        m = grid(np.stack([rows[0][0], rows[1][0]]), np.stack([rows[0][1], rows[1][1]]),
                 np.concatenate([rows[0][2], rows[1][2]]))
        f = m.t[0]
        face = np.cross(m.p[f[1]] - m.p[f[0]], m.p[f[2]] - m.p[f[0]])
        parts.append(m if np.dot(face, m.n[f[0]]) > 0 else Mesh(m.p, m.n, m.uv, m.t[:, ::-1]))
    return join(parts)
