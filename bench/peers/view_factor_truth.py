"""View factors of a room around a convex box, in float64 and by no rays.

What two cells exchange if nothing is between them is an integral of ln r along both contours, of which one is in closed
form. What the box hides of it is integrated over the sending cell; of each point of it, the part of the other cell that
lies behind the box is a sum of polygons on the sides of the box, cut by the planes through the point and the cell's
edges, and the factor of a polygon from a point is in closed form (Lambert). So visibility is exact, and the only error
is that of the quadrature over the sender, told by reciprocity, by closure and by halving its steps. `by_segments` is a
second way: points on both cells, and whether the segment between them meets the box."""

import math

import numpy as np
from numba import njit, prange


@njit
def _cut(polygon, count, normal, offset):
    """What of a polygon has `normal . x >= offset` (Sutherland and Hodgman)."""
    kept, m = np.empty((count + 4, 3)), 0
    for i in range(count):
        a, b = polygon[i], polygon[(i + 1) % count]
        da, db = np.dot(normal, a) - offset, np.dot(normal, b) - offset
        da, db = 0.0 if abs(da) < 1e-7 else da, 0.0 if abs(db) < 1e-7 else db
        if da >= 0:
            kept[m] = a
            m += 1
        if da * db < 0:
            kept[m] = a + (b - a) * (da / (da - db))
            m += 1
    return kept, m


@njit
def _cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@njit
def _normal(polygon, count):
    total = np.zeros(3)
    for i in range(1, count - 1):
        total += _cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0])
    return total


@njit
def _area(polygon, count):
    n = _normal(polygon, count)
    return 0.5 * math.sqrt(np.dot(n, n))


@njit
def _from_point(polygon, count, normal):
    """The factor of a polygon from the origin, all of it in front of there."""
    total = 0.0
    for i in range(count):
        a, b = polygon[i], polygon[(i + 1) % count]
        across = _cross(a, b)
        length = math.sqrt(np.dot(across, across))
        if length > 1e-300:
            total += math.atan2(length, np.dot(a, b)) * np.dot(normal, across) / length
    return abs(total) / (2 * math.pi)


@njit
def _planes_through(point, cell, count, ball):
    """Through a point and each edge of a cell, pointing inwards; none if the ball lies beyond one of them."""
    planes, middle = np.empty((4, 3)), np.zeros(3)
    for i in range(count):
        middle += (cell[i] - point) / count
    for i in range(count):
        plane = _cross(cell[i] - point, cell[(i + 1) % count] - point)
        planes[i] = plane * math.copysign(1 / math.sqrt(np.dot(plane, plane)), np.dot(plane, middle))
        if np.dot(planes[i], ball[:3] - point) < -ball[3]:
            return planes, 0
    return planes, count


@njit
def _hidden_from_point(point, normal, cell, count, box, ball):
    """The factor of that part of a cell that lies behind the box."""
    total, (planes, cuts) = 0.0, _planes_through(point, cell, count, ball)
    for side in range(len(box) if cuts else 0):
        polygon, m = box[side] - point, 4
        if np.dot(_normal(polygon, 4), polygon[0]) >= 0:  # this side is not seen from here
            continue
        for i in range(cuts):
            polygon, m = _cut(polygon, m, planes[i], 0.0)
            if m < 3:
                break
        if m >= 3:
            total += _from_point(polygon, m, normal)
    return total


@njit
def _inner(p, a, b):
    """The integral of ln r along the edge from a to b, of unit length in its parameter, as seen from p."""
    edge, to_a = b - a, p - a
    length = math.sqrt(np.dot(edge, edge))
    along = np.dot(to_a, edge) / length
    off = to_a - edge * (along / length)
    d = math.sqrt(np.dot(off, off))
    total = 0.0
    for s, sign in ((length - along, 1.0), (-along, -1.0)):
        r2 = s * s + d * d
        value = 0.5 * s * math.log(r2) - s if r2 > 1e-300 else 0.0
        total += sign * (value + (d * math.atan(s / d) if d > 1e-14 else 0.0))
    return total / length


@njit
def _contours(first, m, second, k, nodes, weights):
    """A_i F_ij of polygons all of which see each other."""
    total = 0.0
    for i in range(m):
        a, along = first[i], first[(i + 1) % m] - first[i]
        for j in range(k):
            c, d = second[j], second[(j + 1) % k]
            dot = np.dot(along, d - c)
            if abs(dot) > 1e-15:
                for q in range(len(nodes)):
                    total += weights[q] * dot * _inner(a + nodes[q] * along, c, d)
    return abs(total) / (2 * math.pi)


@njit(parallel=True)
def _exchanges_in_the_open(cells, counts, sides, nodes, weights):
    n = len(cells)
    result = np.zeros((n, n))
    for i in prange(n):
        for j in range(i):
            if sides[i] == sides[j]:
                continue
            ni, nj = _normal(cells[i], counts[i]), _normal(cells[j], counts[j])
            ni, nj = ni / math.sqrt(np.dot(ni, ni)), nj / math.sqrt(np.dot(nj, nj))
            first, m = _cut(cells[i], counts[i], nj, np.dot(nj, cells[j, 0]))
            second, k = _cut(cells[j], counts[j], ni, np.dot(ni, cells[i, 0]))
            if m >= 3 and k >= 3 and _area(first, m) > 1e-12 and _area(second, k) > 1e-12:
                result[i, j] = result[j, i] = _contours(first, m, second, k, nodes, weights)
    return result


@njit(parallel=True)
def _exchanges_hidden(cells, counts, sides, walls, box, ball, steps, nodes, weights):
    n = len(cells)
    result = np.zeros((n, n))
    for i in prange(walls):
        cell, normal = cells[i], _normal(cells[i], counts[i])
        normal /= math.sqrt(np.dot(normal, normal))
        area, is_triangle = _area(cell, counts[i]), counts[i] == 3
        ab, last = cell[1] - cell[0], cell[2] - cell[1]
        for step in range(steps * steps * len(nodes) * len(nodes)):
            su, rest = divmod(step, steps * len(nodes) * len(nodes))
            sv, rest = divmod(rest, len(nodes) * len(nodes))
            qu, qv = divmod(rest, len(nodes))
            u, v = (su + nodes[qu]) / steps, (sv + nodes[qv]) / steps
            weight = weights[qu] * weights[qv] / steps**2 * area
            if is_triangle:
                weight, v = weight * 2 * u, v * u
            point = cell[0] + u * ab + v * last
            for j in range(walls):
                if sides[j] != sides[i]:
                    result[i, j] += weight * _hidden_from_point(point, normal, cells[j], counts[j], box, ball)
    return result


def _gauss(order):
    nodes, weights = np.polynomial.legendre.leggauss(order)
    return (nodes + 1) / 2, weights / 2


def _double_exponential(steps=40):
    """Nodes that endure the logarithm at the ends of an edge (Takahasi and Mori)."""
    t = np.linspace(-3.2, 3.2, 2 * steps + 1)
    inside = np.pi / 2 * np.sinh(t)
    weights = np.pi / 4 * np.cosh(t) / np.cosh(inside) ** 2 * (t[1] - t[0])
    return 1 / (1 + np.exp(-2 * inside)), weights


def _ball_around(box):
    corners = box.reshape(-1, 3)
    middle = corners.mean(0)
    return np.append(middle, np.linalg.norm(corners - middle, axis=1).max())


def areas(room):
    return np.array([_area(cell, count) for cell, count in zip(room.cells, room.counts)])


def view_factors(room, steps):
    """F by the mean of both directions, how far off each may be, and how that is known.

    `room.cells`: (n, 4, 3) float64, parallelograms or triangles (`counts`), the first `walls` of them of the room;
    `box`: its six sides, outwards. Cells of the same number in `sides` do not see each other. Nothing hides a wall
    from the box."""
    cells, area, box = (room.cells, room.counts, room.sides), areas(room), room.box
    in_the_open = _exchanges_in_the_open(*cells, *_double_exponential())
    coarse, fine = (
        _exchanges_hidden(*cells, room.walls, box, _ball_around(box), s, *_gauss(2)) for s in (steps // 2, steps)
    )
    exchange = in_the_open - (fine + fine.T) / 2
    exchange[np.abs(exchange) < 1e-9] = 0
    factors, asymmetry = exchange / area[:, None], np.abs(fine - fine.T) / area[:, None]
    error = asymmetry + np.abs(fine + fine.T - coarse - coarse.T) / 2 / area[:, None]
    is_open = in_the_open > 1e-9
    kinds = np.where(~is_open, 0, np.where(exchange == 0, 1, np.where(fine + fine.T > 1e-6 * in_the_open, 2, 3)))
    return (
        factors,
        error,
        kinds,
        {
            "closure_max": float(np.abs(factors.sum(1) - 1).max()),
            "closure_rms": float(np.sqrt(np.mean((factors.sum(1) - 1) ** 2))),
            "reciprocity_max": float(asymmetry.max()),
            "reciprocity_rms": float(np.sqrt(np.mean(asymmetry**2))),
            "halving_rms": float(np.sqrt(np.mean(((fine - coarse) / area[:, None]) ** 2))),
        },
    )


def by_segments(room, i, j, log2_points=20, seed=1):
    """F_ij from points on both parallelograms or triangles, and the slab test of the segments between them."""
    from scipy.stats import qmc

    at = qmc.Sobol(4, seed=seed).random_base2(log2_points)
    first, second = (_points_on(room.cells[c], room.counts[c], at[:, 2 * k : 2 * k + 2]) for k, c in enumerate((i, j)))
    normals = [_normal(room.cells[c], room.counts[c]) for c in (i, j)]
    normals = [n / np.linalg.norm(n) for n in normals]
    between = second - first
    squared = np.einsum("ij,ij->i", between, between)
    kernel = np.maximum(between @ normals[0], 0) * np.maximum(-(between @ normals[1]), 0) / (np.pi * squared**2)
    return float((kernel * ~_meet_box(first, between, room.box)).mean() * areas(room)[j])


def _points_on(cell, count, at):
    u, v = at[:, :1], at[:, 1:]
    if count == 3:
        u = np.sqrt(u)
        v = v * u
    return cell[0] + u * (cell[1] - cell[0]) + v * (cell[2] - cell[1])


def _meet_box(start, along, box):
    """Slabs, in coordinates in which the box is the unit cube."""
    low = box[0, 0]
    edges = np.stack([box[0, 3] - low, box[0, 1] - low, box[1, 1] - low])
    frame = np.linalg.inv(edges)
    start, along = (start - low) @ frame, along @ frame
    with np.errstate(divide="ignore"):
        ends = np.stack([(0 - start) / along, (1 - start) / along])
    near, far = ends.min(0).max(1), ends.max(0).min(1)
    return (near < far) & (far > 0) & (near < 1)
