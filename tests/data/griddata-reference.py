# Makes griddata-points.txt and griddata-values.txt with SciPy (BSD licence), run by hand:  python3 griddata-reference.py
# Columns of the points: x y z. Of the values: x y, z of one interpolation, z of the modified griddata with spacing 9;
# nan outside the convex hull. tol and maxiter let SciPy's iteration for the gradients converge to rounding.
import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator
from scipy.spatial import ConvexHull

SPACING = 9.0
CONVERGED = dict(tol=1e-14, maxiter=100000)


def uniform_nodes(points):
    """Along the hull in steps of at most SPACING; inside, a grid about the bounding box's middle, half a step off."""
    hull = ConvexHull(points)
    corners = points[hull.vertices]
    nodes = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        parts = int(np.ceil(np.linalg.norm(b - a) / SPACING))
        nodes += [a + (b - a) * i / parts for i in range(parts)]
    low, high = points.min(axis=0), points.max(axis=0)
    half = np.floor((high - low) / (2 * SPACING))
    for row in np.arange(-half[1], half[1] + 1):
        for column in np.arange(-half[0], half[0] + 1):
            node = (low + high) / 2 + SPACING * np.array([column, row])
            if (hull.equations[:, :2] @ node + hull.equations[:, 2]).max() < -SPACING / 2:
                nodes.append(node)
    return np.array(nodes)


random = np.random.default_rng(5)
xy = random.uniform(0, 100, (24, 2))
z = xy[:, 0] ** 2 / 200 + 5 * np.sin(xy[:, 1] / 12) + xy[:, 0] * xy[:, 1] / 300 + random.normal(0, 0.1, 24)
at = random.uniform(-5, 105, (80, 2))
once = CloughTocher2DInterpolator(xy, z, **CONVERGED)

nodes = uniform_nodes(xy)
towards_middle = xy.mean(axis=0) + (nodes - xy.mean(axis=0)) * (1 - 1e-12)  # rounding puts some outside the hull
# A slight shear makes qhull divide each square of the grid by the diagonal from its lower left corner, as fettle does.
sheared = nodes - 1e-7 * nodes[:, ::-1] * [1, 0]
twice = CloughTocher2DInterpolator(sheared, once(towards_middle), **CONVERGED)

np.savetxt("griddata-points.txt", np.c_[xy, z], fmt="%.17g")
np.savetxt("griddata-values.txt", np.c_[at, once(at), twice(at)], fmt="%.17g")
