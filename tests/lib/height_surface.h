#pragma once

#include "mesh/mesh.h"

#include <functional>

namespace fettle {

/// z(x, y) over a square of some cells a side, two triangles each, facing up.
inline mesh::Mesh height_surface(double from, double to, int cells, const std::function<double(double, double)>& z)
{
    mesh::Mesh mesh;
    const int side = cells + 1;
    mesh.vertices.resize(3, side * side);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const double x = from + (to - from) * i / cells, y = from + (to - from) * j / cells;
            mesh.vertices.col(j * side + i) << x, y, z(x, y);
        }
    mesh.triangles.resize(3, 2 * cells * cells);
    for (int j = 0, t = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const int a = j * side + i;
            mesh.triangles.col(t++) << a, a + 1, a + side + 1;
            mesh.triangles.col(t++) << a, a + side + 1, a + side;
        }
    return mesh;
}

} // namespace fettle
