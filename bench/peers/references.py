"""What is true, by other ways than the backends'."""
from fractions import Fraction

import numpy as np

# Unit squares, opposite and at a right angle (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and
# C-14).
OPPOSITE, ADJACENT = 0.19982489569838746, 0.2000437760754031


def distances(points, triangles):
    """Of each point from the nearest triangle, all of them tried."""
    return np.array([_nearest(point, triangles) for point in points])


def _nearest(point, triangles):
    edges = [(triangles[:, i], triangles[:, (i + 1) % 3] - triangles[:, i]) for i in range(3)]
    best = np.inf
    for start, edge in edges:
        along = np.clip(np.einsum("ij,ij->i", point - start, edge) / np.einsum("ij,ij->i", edge, edge), 0, 1)
        best = min(best, np.min(np.linalg.norm(point - start - along[:, None] * edge, axis=1)))
    normal = np.cross(edges[0][1], -edges[2][1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    inside = np.all([np.einsum("ij,ij->i", np.cross(edge, point - start), normal) > 0 for start, edge in edges], axis=0)
    if inside.any():
        best = min(best, np.min(np.abs(np.einsum("ij,ij->i", point - triangles[inside, 0], normal[inside]))))
    return best


def ray_distances(origins, directions, triangles):
    """t where each ray meets the plane of its triangle."""
    origins, directions, triangles = (each.astype(np.float64) for each in (origins, directions, triangles))
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.einsum("ij,ij->i", triangles[:, 0] - origins, normal) / np.einsum("ij,ij->i", directions, normal)


def room_error(between, centers, walls):
    """Of factors between the walls of a unit cube, which are areas of 1."""
    middle = np.array([centers[walls == wall].mean(0) for wall in range(6)])
    is_opposite = np.linalg.norm(middle[:, None] - middle[None], axis=2) > 0.9
    truth = np.where(is_opposite, OPPOSITE, ADJACENT)
    np.fill_diagonal(truth, 0)
    return float(np.max(np.abs(between - truth)))


def are_inside(points, triangles):
    """By the sum of the solid angles of all triangles (van Oosterom and Strackee 1983)."""
    return np.array([_winding(triangles - point) > 0.5 for point in points])


def _winding(t):
    a, b, c = t[:, 0], t[:, 1], t[:, 2]
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    dots = [np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a))]
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    return 2 * np.arctan2(volume, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb).sum() / (4 * np.pi)


def meet(first, second):
    """Whether two triangles have a point in common, without rounding: the first, as a polygon, is cut by both sides of the
    second's plane, and what is left by the planes through the second's edges."""
    a, b = ([[Fraction(float(x)) for x in corner] for corner in t] for t in (first, second))
    normal = _cross(_minus(b[1], b[0]), _minus(b[2], b[0]))
    if not any(normal):
        normal_a = _cross(_minus(a[1], a[0]), _minus(a[2], a[0]))
        if any(normal_a):
            return _is_met(b, a, normal_a)
        return _segments_meet(_span(a), _span(b))
    return _is_met(a, b, normal)


def _is_met(polygon, t, normal):
    for sign in (1, -1):
        polygon = _cut(polygon, [sign * x for x in normal], t[0])
    for i in range(3):
        outward = _cross(_minus(t[(i + 1) % 3], t[i]), normal)
        polygon = _cut(polygon, outward, t[i])
    return bool(polygon)


def _cut(polygon, outward, at):
    """What is not beyond the plane through `at`; a polygon may be a segment or a point."""
    kept, heights = [], [_dot(_minus(p, at), outward) for p in polygon]
    for i, (p, h) in enumerate(zip(polygon, heights)):
        q, k = polygon[(i + 1) % len(polygon)], heights[(i + 1) % len(polygon)]
        if h <= 0:
            kept.append(p)
        if h * k < 0:
            kept.append([x + (y - x) * h / (h - k) for x, y in zip(p, q)])
    return kept


def _span(t):
    return min(t), max(t)


def _segments_meet(s, t):
    """Of two segments or points: they meet where the system s0 + u ds = t0 + v dt has a solution within [0, 1]."""
    ds, dt, gap = _minus(s[1], s[0]), _minus(t[1], t[0]), _minus(t[0], s[0])
    across = _cross(ds, dt)
    if any(across):
        if _dot(gap, across) != 0:
            return False
        square = _dot(across, across)
        u, v = _dot(_cross(gap, dt), across) / square, _dot(_cross(gap, ds), across) / square
        return 0 <= u <= 1 and 0 <= v <= 1
    along = ds if any(ds) else dt
    if any(_cross(gap, along)):
        return False
    return max(s[0], t[0]) <= min(s[1], t[1])


def _minus(p, q):
    return [x - y for x, y in zip(p, q)]


def _dot(p, q):
    return sum(x * y for x, y in zip(p, q))


def _cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
