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


def facing(mesh, centre=None):
    """The same mesh with every triangle wound to the side of its vertices' normals, or, where `centre` is given, away
    from that point."""
    a, b, c = (mesh.p[mesh.t[:, k]] for k in range(3))
    out = mesh.n[mesh.t].sum(axis=1) if centre is None else (a + b + c) / 3 - np.asarray(centre, float)
    wrong = np.einsum("ij,ij->i", np.cross(b - a, c - a), out) < 0
    t = mesh.t.copy()
    t[wrong] = t[wrong][:, ::-1]
    return Mesh(mesh.p, mesh.n, mesh.uv, t)


def deformed(mesh, f, step=1e-5):
    """The mesh under a smooth map of space, f of (n, 3) positions; normals follow the map's derivative, by central
    differences over `step` metres."""
    j = np.stack([(f(mesh.p + step * e) - f(mesh.p - step * e)) / (2 * step) for e in np.eye(3)], 2)
    n = np.linalg.solve(np.swapaxes(j, 1, 2), mesh.n[:, :, None])[:, :, 0]
    n *= np.sign(np.linalg.det(j))[:, None]
    return facing(Mesh(f(mesh.p), n / np.linalg.norm(n, axis=1, keepdims=True), mesh.uv, mesh.t))


def chamfer(lo, hi, edge):
    """Axis-aligned box whose edges are cut back by `edge` metres; the faces' normals run on over the cut, so that edges
    look rounded. 44 triangles, uv in metres."""
    lo, hi = np.minimum(lo, hi).astype(float), np.maximum(lo, hi).astype(float)
    edge = min(edge, 0.49 * float((hi - lo).min()))
    corners = [np.array(c) for c in np.ndindex(2, 2, 2)]
    p, n, at = [], [], {}
    for c in corners:
        for axis in range(3):
            v = np.where(c == 1, hi - edge, lo + edge)
            v[axis] = (lo, hi)[c[axis]][axis]
            at[(*c, axis)] = len(p)
            p.append(v), n.append(np.eye(3)[axis] * (2 * c[axis] - 1))
    t = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            ring = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                c = np.zeros(3, int)
                c[axis], c[u], c[v] = side, a, b
                ring.append(at[(*c, axis)])
            t += [ring[:3], [ring[0], ring[2], ring[3]]]
        for a in (0, 1):   # the cuts along this axis
            for b in (0, 1):
                c = np.zeros(3, int)
                c[u], c[v] = a, b
                d = c.copy()
                d[axis] = 1
                q = [at[(*c, u)], at[(*d, u)], at[(*d, v)], at[(*c, v)]]
                t += [q[:3], [q[0], q[2], q[3]]]
    t += [[at[(*c, axis)] for axis in range(3)] for c in corners]
    return planar_uv(facing(Mesh(p, n, None, t), (lo + hi) / 2))


def slab(lo, hi, axis, holes=()):
    """A box pierced along `axis` ('x', 'y', 'z') by rectangular holes: walls with windows and doors, ceilings with roof
    lights. holes: (a0, a1, b0, b1) along the other two axes, in the order z y for 'x', x z for 'y', x y for 'z'; a hole
    may reach the box's edge. All quads share whole edges. uv in metres."""
    k = "xyz".index(axis)
    u, v = {0: (2, 1), 1: (0, 2), 2: (0, 1)}[k]
    cuts = [sorted({float(lo[w]), float(hi[w])} |
                   {min(max(float(h[i]), lo[w]), hi[w]) for h in holes for i in ((0, 1) if w == u else (2, 3))})
            for w in (u, v)]

    def solid(i, j):
        if not (0 <= i < len(cuts[0]) - 1 and 0 <= j < len(cuts[1]) - 1):
            return False
        a, b = (cuts[0][i] + cuts[0][i + 1]) / 2, (cuts[1][j] + cuts[1][j + 1]) / 2
        return not any(h[0] < a < h[1] and h[2] < b < h[3] for h in holes)

    parts = []
    names = ("x", "y", "z")
    for i in range(len(cuts[0]) - 1):
        for j in range(len(cuts[1]) - 1):
            if not solid(i, j):
                continue
            a, b = [0.0] * 3, [0.0] * 3
            a[k], b[k] = lo[k], hi[k]
            a[u], b[u] = cuts[0][i], cuts[0][i + 1]
            a[v], b[v] = cuts[1][j], cuts[1][j + 1]
            hidden = [s + names[w] for s, w, di, dj in (("-", u, -1, 0), ("+", u, 1, 0), ("-", v, 0, -1),
                                                        ("+", v, 0, 1)) if solid(i + di, j + dj)]
            parts.append(box(a, b, " ".join(hidden)))
    return join(parts)


def superquadric(half, square=0.4, lens=1.0, segments=32, rings=16):
    """A closed cushion about the origin with half extents `half`: `square` 1 is round seen from above, towards 0 a
    rectangle; `lens` the same for its profile. Normals are exact."""
    th = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)[:, None]
    ph = np.linspace(0, 2 * np.pi, segments + 1)[None, :]

    def power(x, e):
        return np.sign(x) * np.abs(np.where(np.abs(x) < 1e-12, 0, x)) ** e

    def both(fx, fy):
        return np.stack([fx * power(np.sin(ph), fy), power(np.sin(th), lens if fy == square else 2 - lens) + 0 * ph,
                         fx * power(np.cos(ph), fy)], 2)

    half = np.asarray(half, float)
    p = both(power(np.cos(th), lens), square) * half
    n = both(power(np.cos(th), 2 - lens), 2 - square) / half
    p[:, -1], n[:, -1] = p[:, 0], n[:, 0]
    p[0], p[-1] = (0, -half[1], 0), (0, half[1], 0)
    n[0], n[-1] = (0, -1, 0), (0, 1, 0)
    return facing(grid(p, n.reshape(-1, 3)))


def bezier(patch, steps, centre_line=None):
    """A bicubic Bezier patch of 4 x 4 control points as steps x steps quads. Normals are exact; where a derivative
    vanishes (a pole), that of the nearest inner point's tangent plane in the limit. `centre_line`: points the normals
    away from this function of the surface's points."""
    t = np.linspace(0, 1, steps + 1)

    def basis(t):
        s = 1 - t
        return (np.stack([s ** 3, 3 * s * s * t, 3 * s * t * t, t ** 3], 1),
                np.stack([-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t], 1))

    c = np.asarray(patch, float).reshape(4, 4, 3)
    (b, d), inner = basis(t), np.clip(t, 1e-4, 1 - 1e-4)
    p = np.einsum("ui,vj,ijk->uvk", b, b, c)
    bi, di = basis(inner)
    n = np.cross(np.einsum("ui,vj,ijk->uvk", d, b, c), np.einsum("ui,vj,ijk->uvk", b, d, c))
    near = np.cross(np.einsum("ui,vj,ijk->uvk", di, bi, c), np.einsum("ui,vj,ijk->uvk", bi, di, c))
    size = np.linalg.norm(n, axis=2, keepdims=True)
    n = np.where(size > 1e-9 * max(size.max(), 1e-12), n, near)
    n /= np.maximum(np.linalg.norm(n, axis=2, keepdims=True), 1e-30)
    if centre_line is not None:
        out = np.einsum("ijk,ijk->", n, p - centre_line(p))
        n = n if out > 0 else -n
    return facing(grid(p, n.reshape(-1, 3)))
