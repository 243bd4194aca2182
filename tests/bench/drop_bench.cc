// How fast cutters come down on a mesh: a million positions over the mould of samples/ (DESIGN: another design), whose
// triangles are cut in sixteen (141,792 of them), by two threads; without the time for the tree.

#include "geometry/bounding_box.h"
#include "machining/drop_cutter.h"
#include "mesh/mesh_file.h"

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdlib>
#include <utility>

using namespace fettle;

namespace {

/// Every triangle in four.
mesh::Mesh subdivided(const mesh::Mesh& mesh)
{
    const Eigen::Index count = mesh.triangles.cols(), vertices = mesh.vertices.cols();
    mesh::Mesh fine;
    fine.vertices.resize(3, vertices + 3 * count);
    fine.vertices.leftCols(vertices) = mesh.vertices;
    fine.triangles.resize(3, 4 * count);
    for (Eigen::Index t = 0; t < count; ++t) {
        const Eigen::Vector3i c = mesh.triangles.col(t);
        Eigen::Vector3i middle; // of the side after each corner
        for (int k = 0; k < 3; ++k) {
            middle[k] = static_cast<int>(vertices + 3 * t + k);
            fine.vertices.col(middle[k]) = (mesh.vertices.col(c[k]) + mesh.vertices.col(c[(k + 1) % 3])) / 2;
        }
        for (int k = 0; k < 3; ++k) fine.triangles.col(4 * t + k) << c[k], middle[k], middle[(k + 2) % 3];
        fine.triangles.col(4 * t + 3) = middle;
    }
    return fine;
}

void drop(benchmark::State& state)
{
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    const char* design = std::getenv("DESIGN");
    static const mesh::Mesh mesh =
        subdivided(subdivided(mesh::read_mesh(design ? design : "samples/designs/mould.stl", units::Units::Length::m)));
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(mesh.vertices);
    const Eigen::Vector3d size = box.sizes();
    const char* kCutters[] = {"ball:6", "ball:25", "flat:25", "bull:25,5", "taper:25,20,3"};
    const machining::DropCutter cutter(mesh, machining::parse_cutter(kCutters[state.range(0)]));
    state.SetLabel(kCutters[state.range(0)]);
    constexpr int kSide = 1000;
    for (auto _ : state) {
        std::atomic<int> touched = 0;
        tbb::parallel_for(0, kSide, [&](int j) {
            int met = 0;
            for (int i = 0; i < kSide; ++i)
                met +=
                    cutter({box.min().x() + size.x() * (i + 0.5) / kSide, box.min().y() + size.y() * (j + 0.5) / kSide})
                        .has_value();
            touched += met;
        });
        state.counters["touched"] = touched.load();
    }
}
BENCHMARK(drop)->DenseRange(0, 4)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

} // namespace
