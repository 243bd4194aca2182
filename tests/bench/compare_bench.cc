// Signed distances to a mesh beside the same by Embree's point query: preparation and query, all threads, in turn, so
// that their ratio is meaningful on a busy machine, too. The expected ratio is printed beside them. A sample of the
// points is measured by brute force as well.
//   of_embree     time of fettle / time of Embree        of_embree_cpu  the same of processor time
//   worst_mm      largest difference from brute force    wrong_signs    of the sample

#include "compare/signed_distance.h"
#include "mesh/mesh_index.h"
#include "mesh/triangle.h"

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

using namespace fettle;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct Scene {
    mesh::Mesh mesh;
    Eigen::Matrix3Xd points;
};

/// A grid of `across` x `along` cells over the unit square, closed in either direction or not.
mesh::Mesh grid(int across, int along, bool closed, const std::function<Eigen::Vector3d(double, double)>& at)
{
    const int rows = along + (closed ? 0 : 1), columns = across + (closed ? 0 : 1);
    mesh::Mesh mesh;
    mesh.vertices.resize(3, rows * columns);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            mesh.vertices.col(j * columns + i) =
                at(static_cast<double>(i) / across, static_cast<double>(j) / along).cast<float>().cast<double>();
    mesh.triangles.resize(3, 2 * across * along);
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < across; ++i) {
            const int right = (i + 1) % columns, up = (j + 1) % rows;
            const int a = j * columns + i, b = j * columns + right, c = up * columns + right, d = up * columns + i;
            mesh.triangles.col(2 * (j * across + i)) << a, b, c;
            mesh.triangles.col(2 * (j * across + i) + 1) << a, c, d;
        }
    return mesh;
}

/// A wavy field of a million facets, scanned line by line within 0.5 mm.
Scene wavy()
{
    const auto height = [](double x, double y) {
        return 6 * std::sin(kTurn * x / 120) + 4 * std::cos(kTurn * y / 90) + std::sin(kTurn * (x + y) / 17);
    };
    Scene scene;
    scene.mesh = grid(1000, 500, false,
                      [&](double u, double v) { return Eigen::Vector3d(500 * u, 250 * v, height(500 * u, 250 * v)); });
    std::mt19937 random(1);
    std::uniform_real_distribution<double> jitter(0.1, 0.9), off(-0.5, 0.5);
    scene.points.resize(3, 1000 * 1000);
    for (int i = 0; i < 1000 * 1000; ++i) {
        const double x = 1 + 0.498 * (i % 1000 + jitter(random)), y = 1 + 0.248 * (i / 1000 + jitter(random));
        scene.points.col(i) << x, y, height(x, y) + off(random);
    }
    return scene;
}

/// A bumpy torus of 200 000 facets; half of the points near it, half anywhere, in no order.
Scene torus()
{
    const auto at = [](double u, double v, double lift) -> Eigen::Vector3d {
        const double r = 30 + 2 * std::sin(8 * kTurn * u) * std::sin(5 * kTurn * v) + lift;
        const double ring = 100 + r * std::cos(kTurn * v);
        return {ring * std::cos(kTurn * u), ring * std::sin(kTurn * u), r * std::sin(kTurn * v)};
    };
    Scene scene;
    scene.mesh = grid(500, 200, true, [&](double u, double v) { return at(u, v, 0); });
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1), side(-1, 1);
    scene.points.resize(3, 500000);
    for (Eigen::Index i = 0; i < scene.points.cols(); ++i)
        if (random() % 2 == 0)
            scene.points.col(i) = at(unit(random), unit(random), 2 * side(random));
        else
            scene.points.col(i) << 160 * side(random), 160 * side(random), 45 * side(random);
    return scene;
}

struct Query {
    const compare::ReferenceMesh* reference;
    Eigen::Vector3d point;
    mesh::TrianglePoint nearest;
    mesh::MeshIndex::Closest closest;
};

mesh::Triangle corners_of(const mesh::Mesh& mesh, Eigen::Index t)
{
    mesh::Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, t));
    return corners;
}

void offer(Query& query, Eigen::Index t)
{
    const mesh::TrianglePoint found = mesh::closest_on_triangle(corners_of(query.reference->mesh, t), query.point);
    if (found.squared_distance >= query.nearest.squared_distance) return;
    query.nearest = found;
    query.closest = {found.point, t, found.barycentric};
}

/// Angle-weighted pseudo-normals from a table of the facets at each vertex, as a program around Embree has them. Facets
/// have an area.
class TableOfNormals {
  public:
    explicit TableOfNormals(const mesh::Mesh& mesh) : mesh_(mesh), first_(mesh.vertices.cols() + 1, 0)
    {
        for (const int v : mesh.triangles.reshaped()) ++first_[v + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        facets_.resize(mesh.triangles.size());
        std::vector<std::uint32_t> next = first_;
        for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
            for (const int v : mesh.triangles.col(t)) facets_[next[v]++] = static_cast<std::uint32_t>(t);
    }

    /// @param foot  where it lies is told by its zero coordinates: two at a vertex, one on an edge
    Eigen::Vector3d normal(const mesh::MeshIndex::Closest& foot) const
    {
        const Eigen::Vector3i corners = mesh_.triangles.col(foot.triangle);
        const Eigen::Vector3d& weight = foot.barycentric;
        for (int i = 0; i < 3; ++i)
            if (weight[(i + 1) % 3] == 0 && weight[(i + 2) % 3] == 0) return vertex_normal(corners[i]);
        Eigen::Vector3d sum = facet_normal(foot.triangle);
        for (int i = 0; i < 3; ++i)
            if (weight[i] == 0) sum += normal_across(foot.triangle, corners[(i + 1) % 3], corners[(i + 2) % 3]);
        return sum;
    }

  private:
    Eigen::Vector3d facet_normal(Eigen::Index t) const
    {
        const mesh::Triangle c = corners_of(mesh_, t);
        return (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).normalized();
    }

    Eigen::Vector3d normal_across(Eigen::Index facet, int a, int b) const
    {
        for (std::uint32_t k = first_[a]; k < first_[a + 1]; ++k)
            if (facets_[k] != facet && (mesh_.triangles.col(facets_[k]).array() == b).any())
                return facet_normal(facets_[k]);
        return Eigen::Vector3d::Zero();
    }

    Eigen::Vector3d vertex_normal(int v) const
    {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) {
            const Eigen::Vector3i c = mesh_.triangles.col(facets_[k]);
            const int corner = c[0] == v ? 0 : c[1] == v ? 1 : 2;
            const Eigen::Vector3d p = mesh_.vertices.col(v), to_b = mesh_.vertices.col(c[(corner + 1) % 3]) - p,
                                  to_c = mesh_.vertices.col(c[(corner + 2) % 3]) - p;
            sum += std::atan2(to_b.cross(to_c).norm(), to_b.dot(to_c)) * facet_normal(facets_[k]);
        }
        return sum;
    }

    const mesh::Mesh& mesh_;
    std::vector<std::uint32_t> first_, facets_;
};

double signed_by(const TableOfNormals& normals, const Query& query)
{
    const Eigen::Vector3d offset = query.point - query.nearest.point;
    return std::copysign(offset.norm(), offset.dot(normals.normal(query.closest)));
}

/// By the region that the point lies in: no more than Embree's query needs (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5).
double squared_distance(const Eigen::Vector3d& p, const mesh::Mesh& mesh, Eigen::Index t)
{
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t)), b = mesh.vertices.col(mesh.triangles(1, t)),
                          c = mesh.vertices.col(mesh.triangles(2, t));
    const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
    if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
    if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - ab * (d1 / (d1 - d3))).squaredNorm();
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - ac * (d2 / (d2 - d6))).squaredNorm();
    if (va <= 0 && d4 >= d3 && d5 >= d6) return (bp - (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6))).squaredNorm();
    return (ap - (ab * vb + ac * vc) / (va + vb + vc)).squaredNorm();
}

bool approach(RTCPointQueryFunctionArguments* arguments)
{
    Query& query = *static_cast<Query*>(arguments->userPtr);
    if (squared_distance(query.point, query.reference->mesh, arguments->primID) > query.nearest.squared_distance)
        return false;
    offer(query, arguments->primID);
    constexpr double kUp = 1 + 1e-6; // floats round
    const auto radius = static_cast<float>(std::sqrt(query.nearest.squared_distance) * kUp);
    if (radius >= arguments->query->radius) return false;
    arguments->query->radius = radius;
    return true;
}

Query query_at(const compare::ReferenceMesh& reference, const Eigen::Vector3d& point)
{
    Query query{&reference, point, {}, {}};
    query.nearest.squared_distance = std::numeric_limits<double>::infinity();
    return query;
}

Eigen::VectorXd by_embree(const Scene& scene)
{
    const compare::ReferenceMesh reference = compare::reference_mesh(scene.mesh);
    const TableOfNormals normals(reference.mesh);
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene tree = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const mesh::Mesh& mesh = reference.mesh;
    const auto buffer = [&](RTCBufferType type, RTCFormat format, Eigen::Index count) {
        return rtcSetNewGeometryBuffer(geometry, type, 0, format, 12, static_cast<std::size_t>(count));
    };
    Eigen::Matrix3Xf::Map(static_cast<float*>(buffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices.cols())),
                          3, mesh.vertices.cols()) = mesh.vertices.cast<float>();
    Eigen::Matrix3Xi::Map(static_cast<int*>(buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.cols())), 3,
                          mesh.triangles.cols()) = mesh.triangles;
    rtcSetGeometryPointQueryFunction(geometry, approach);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree, geometry);
    rtcCommitScene(tree);
    Eigen::VectorXd errors(scene.points.cols());
    tbb::parallel_for(Eigen::Index{0}, errors.size(), [&](Eigen::Index i) {
        Query query = query_at(reference, scene.points.col(i));
        RTCPointQuery sphere = {static_cast<float>(query.point.x()), static_cast<float>(query.point.y()),
                                static_cast<float>(query.point.z()), 0, std::numeric_limits<float>::infinity()};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(tree, &sphere, &context, nullptr, &query);
        errors[i] = signed_by(normals, query);
    });
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(tree);
    rtcReleaseDevice(device);
    return errors;
}

struct Stopwatch {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::clock_t cpu_start = std::clock();
    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
    double cpu() const { return static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC; }
};

/// Differences of a sample from the nearest of all facets, by brute force.
void check(benchmark::State& state, const Scene& scene, const Eigen::VectorXd& errors)
{
    const compare::ReferenceMesh reference = compare::reference_mesh(scene.mesh);
    const TableOfNormals normals(reference.mesh);
    double worst = 0, wrong = 0;
    for (Eigen::Index i = 0; i < errors.size(); i += errors.size() / 50) {
        Query query = query_at(reference, scene.points.col(i));
        for (Eigen::Index t = 0; t < reference.mesh.triangles.cols(); ++t) offer(query, t);
        const double exact = signed_by(normals, query);
        worst = std::max(worst, std::abs(std::abs(exact) - std::abs(errors[i])));
        wrong += exact * errors[i] < 0;
    }
    state.counters["worst_mm"] = worst;
    state.counters["wrong_signs"] = wrong;
}

/// @param bar  what the ratios should be
void signed_distances(benchmark::State& state, const std::function<Scene()>& make, const char* bar)
{
    state.SetLabel(bar);
    const Scene scene = make();
    double wall = 0, cpu = 0, embree_wall = 0, embree_cpu = 0;
    Eigen::VectorXd errors;
    for (auto _ : state) {
        const Stopwatch ours;
        errors = compare::signed_distance(scene.points, scene.mesh).error;
        wall += ours.wall();
        cpu += ours.cpu();
        state.SetIterationTime(ours.wall());
        const Stopwatch theirs;
        benchmark::DoNotOptimize(by_embree(scene));
        embree_wall += theirs.wall();
        embree_cpu += theirs.cpu();
    }
    state.counters["of_embree"] = wall / embree_wall;
    state.counters["of_embree_cpu"] = cpu / embree_cpu;
    check(state, scene, errors);
}
BENCHMARK_CAPTURE(signed_distances, wavy, wavy, "bar: of_embree <= 0.5")
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(signed_distances, torus, torus, "bar: of_embree_cpu <= 0.33")
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);

} // namespace
