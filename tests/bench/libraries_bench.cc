// What fettle wrote itself beside the library that could do the same (race.h). The headers of what is timed here quote
// the ratios.
//   difference   largest difference of the results

#include "race.h"

#include "belt/gridding.h"
#include "clean/neighbour_distances.h"
#include "cloud/pcl.h"
#include "core/product.h"
#include "geometry/point_index.h"
#include "mesh/equal_corners.h"
#include "surface/basis.h"

#include <benchmark/benchmark.h>
#include <Eigen/Cholesky>
#include <pcl/kdtree/kdtree_flann.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <unsupported/Eigen/Splines>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

using namespace fettle;

namespace {

using Eigen::Index, Eigen::Matrix3Xd, Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector3d;

double wave(double x, double y) { return 6 * std::sin(x / 19) + 4 * std::cos(y / 14) + std::sin((x + y) / 3); }

/// The field as a mesh of 2 side² facets.
mesh::Mesh field(int side)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (side + 1) * (side + 1));
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const double x = 500.0 * i / side, y = 500.0 * j / side;
            mesh.vertices.col(j * (side + 1) + i) = Vector3d(x, y, wave(x, y)).cast<float>().cast<double>();
        }
    mesh.triangles.resize(3, 2 * side * side);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const int a = j * (side + 1) + i, d = a + side + 1, t = 2 * (j * side + i);
            mesh.triangles.col(t) << a, a + 1, d + 1;
            mesh.triangles.col(t + 1) << a, d + 1, d;
        }
    return mesh;
}

// --- nearest points -------------------------------------------------------------------------------------------------

/// A scan of a wavy field of 500 mm, line by line, with noise of 0.02 mm.
Matrix3Xd scan(Index count)
{
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.02);
    const auto columns = static_cast<Index>(std::sqrt(static_cast<double>(count)));
    const double pitch = 500 / static_cast<double>(columns);
    Matrix3Xd points(3, count);
    for (Index i = 0; i < count; ++i) {
        const double x = pitch * static_cast<double>(i % columns) + noise(random);
        const double y = pitch * static_cast<double>(i / columns) + noise(random);
        points.col(i) << x, y, wave(x, y) + noise(random);
    }
    return points;
}

constexpr Index kNormalNeighbours = 16; // as in fettle-align

class Pcl {
  public:
    explicit Pcl(const Matrix3Xd& points)
    {
        pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
        for (const Vector3d& p : points.colwise()) cloud->emplace_back(float(p.x()), float(p.y()), float(p.z()));
        tree_.setInputCloud(cloud);
    }

    std::vector<Index> nearest(const Vector3d& query, Index count) const
    {
        pcl::Indices indices;
        std::vector<float> squared;
        const pcl::PointXYZ point(float(query.x()), float(query.y()), float(query.z()));
        tree_.nearestKSearch(point, static_cast<unsigned>(count), indices, squared);
        return {indices.begin(), indices.end()};
    }

  private:
    pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

template <typename Tree>
Index search_all(const Matrix3Xd& points)
{
    const Tree tree(points);
    Eigen::VectorX<Index> farthest(points.cols());
    tbb::parallel_for(Index{0}, points.cols(),
                      [&](Index i) { farthest[i] = tree.nearest(points.col(i), kNormalNeighbours).back(); });
    return farthest.maxCoeff();
}

/// A tree of a scan and the 16 nearest of each of its points: in double, over nanoflann, beside PCL's of floats, over
/// FLANN.
void neighbours_by_pcl(benchmark::State& state)
{
    const Matrix3Xd points = scan(state.range(0));
    race(
        state, [&] { return search_all<geometry::PointIndex<3>>(points); }, [&] { return search_all<Pcl>(points); });
}
BENCHMARK(neighbours_by_pcl)->Arg(100'000)->Arg(1'000'000)->Iterations(4)->Unit(benchmark::kMillisecond);

double sum_by_pcl(const Matrix3Xd& points, int count)
{
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(cloud::to_pcl(points, Vector3d::Zero()));
    Eigen::VectorXd sums(points.cols());
    tbb::parallel_for(Index{0}, points.cols(), [&](Index i) {
        pcl::Indices indices;
        std::vector<float> squared;
        tree.nearestKSearch((*tree.getInputCloud())[static_cast<std::size_t>(i)], count + 1, indices, squared);
        sums[i] = std::sqrt(squared.back());
    });
    return sums.sum();
}

/// The distance of the eighth neighbour of each point, for fettle-clean: all points together, beside PCL's tree.
void neighbour_distances_by_pcl(benchmark::State& state)
{
    const Matrix3Xd points = scan(state.range(0));
    const auto ours = [&] {
        Eigen::VectorXd sums(points.cols());
        clean::for_each_neighbourhood(
            points, 8, [&](Index i, std::span<const float> squared) { sums[i] = std::sqrt(squared.back()); });
        return sums.sum();
    };
    race(state, ours, [&] { return sum_by_pcl(points, 8); });
}
BENCHMARK(neighbour_distances_by_pcl)->Arg(1'000'000)->Iterations(4)->Unit(benchmark::kMillisecond);

// --- equal corners --------------------------------------------------------------------------------------------------

using Corner = mesh::Corner<float>;

mesh::Mesh weld_by_sorting(const std::vector<Corner>& corners)
{
    std::vector<std::pair<Corner, std::uint32_t>> sorted(corners.size());
    tbb::parallel_for(std::size_t{0}, corners.size(), [&](std::size_t i) {
        sorted[i] = {corners[i], static_cast<std::uint32_t>(i)};
        for (float& coordinate : sorted[i].first) coordinate += 0; // turns -0 into +0
    });
    tbb::parallel_sort(sorted);
    std::vector<std::uint32_t> first(corners.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const bool again = i > 0 && sorted[i].first == sorted[i - 1].first;
        first[sorted[i].second] = again ? first[sorted[i - 1].second] : sorted[i].second;
    }
    mesh::Mesh mesh;
    mesh.triangles.resize(3, Index(corners.size() / 3));
    mesh.vertices.resize(3, Index(corners.size()));
    int vertices = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const bool is_new = first[i] == i;
        int& index = mesh.triangles.data()[i];
        index = is_new ? vertices++ : mesh.triangles.data()[first[i]];
        if (is_new) mesh.vertices.col(index) << corners[i][0], corners[i][1], corners[i][2];
    }
    mesh.vertices.conservativeResize(3, vertices);
    return mesh;
}

/// Corners of a million facets of an STL merged into vertices.
void equal_corners_by_parallel_sort(benchmark::State& state)
{
    const mesh::Mesh mesh = field(static_cast<int>(state.range(0)));
    std::vector<Corner> corners;
    for (const int vertex : mesh.triangles.reshaped()) {
        const Eigen::Vector3f p = mesh.vertices.col(vertex).cast<float>();
        corners.push_back({p.x(), p.y(), p.z()});
    }
    const auto ours = [&] {
        mesh::MeshRepair repair;
        const mesh::CornerSource<float> copy = [&](std::size_t from, std::size_t count, Corner* to) {
            std::copy_n(&corners[3 * from], 3 * count, to);
        };
        return mesh::weld_facets<float>(corners.size() / 3, copy, repair);
    };
    if (ours().triangles != weld_by_sorting(corners).triangles) state.SkipWithError("the meshes differ");
    race(state, ours, [&] { return weld_by_sorting(corners); });
}
BENCHMARK(equal_corners_by_parallel_sort)->Arg(707)->Iterations(5)->Unit(benchmark::kMillisecond);

// --- kriging --------------------------------------------------------------------------------------------------------

constexpr Index kNeighbours = 8; // as in belt/gridding.cc

using Near = std::array<Index, kNeighbours>;

Near nearest(const Matrix3Xd& points, const Vector2d& at)
{
    std::vector<std::pair<double, Index>> by_distance;
    for (Index i = 0; i < points.cols(); ++i) by_distance.emplace_back((points.col(i).head<2>() - at).squaredNorm(), i);
    std::ranges::partial_sort(by_distance, by_distance.begin() + kNeighbours);
    Near near;
    for (std::size_t k = 0; k < near.size(); ++k) near[k] = by_distance[k].second;
    return near;
}

/// Ordinary kriging with the variogram γ(d) = d, by Eigen's LDLT.
double krige(const Matrix3Xd& points, const Near& near, const Vector2d& at)
{
    using Matrix = Eigen::Matrix<double, kNeighbours, kNeighbours>;
    using Vector = Eigen::Vector<double, kNeighbours>;
    const Eigen::Matrix<double, 3, kNeighbours> p = points(Eigen::all, near);
    Matrix distances;
    for (Index j = 0; j < kNeighbours; ++j)
        distances.col(j) = (p.topRows<2>().colwise() - Vector2d(p.col(j).head<2>())).colwise().norm().transpose();
    const Vector from_query = (p.topRows<2>().colwise() - at).colwise().norm().transpose();
    const double variance = 2 * std::max(distances.maxCoeff(), from_query.maxCoeff());
    Eigen::Matrix<double, kNeighbours, 2> right;
    right << p.row(2).transpose(), Vector::Ones();
    const Eigen::Matrix<double, kNeighbours, 2> x = Matrix(variance - distances.array()).ldlt().solve(right);
    const Vector b = variance - from_query.array();
    return b.dot(x.col(0)) + (1 - b.dot(x.col(1))) * x.col(0).sum() / x.col(1).sum();
}

/// Heights between the surfels under a wheel, 64 x 64 cells. The library's time is that of the search for neighbours,
/// which Shepard's weights need as well, and of LDLT.
void kriging_by_ldlt(benchmark::State& state)
{
    constexpr Index kCells = 64;
    const belt::ContactGrid cells{{0.5, 0.5}, kCells, kCells};
    const double side = 1.2 * 0.5 * kCells;
    Matrix3Xd points(3, 5900);                  // one a cell
    for (Index i = 0; i < points.cols(); ++i) { // additive recurrence of the plastic number: even, and never in rows
        const double x = side * (std::fmod(0.7548776662466927 * double(i), 1) - 0.5);
        const double y = side * (std::fmod(0.5698402909980532 * double(i), 1) - 0.5);
        points.col(i) << x, y, (x * x + y * y) / 400 + 0.05 * std::sin(x / 2) * std::cos(y / 3);
    }
    std::vector<Near> near(kCells * kCells);
    tbb::parallel_for(Index{0}, kCells * kCells, [&](Index c) {
        near[std::size_t(c)] = nearest(points, cells.cell_center(c % kCells, c / kCells));
    });
    const auto ours = [&] { return belt::interpolate_heights(cells, points, belt::Gridding::kriging).height; };
    const auto by_ldlt = [&] {
        MatrixXd heights = belt::interpolate_heights(cells, points, belt::Gridding::shepard).height;
        tbb::parallel_for(Index{0}, kCells, [&](Index column) {
            for (Index row = 0; row < kCells; ++row)
                heights(row, column) =
                    krige(points, near[std::size_t(column * kCells + row)], cells.cell_center(row, column));
        });
        return heights;
    };
    race(state, ours, by_ldlt);
    state.counters["difference"] = (ours() - by_ldlt()).cwiseAbs().maxCoeff();
}
BENCHMARK(kriging_by_ldlt)->Unit(benchmark::kMillisecond);

// --- B-splines ------------------------------------------------------------------------------------------------------

/// Values and derivatives of the cubic basis functions over 50 knots.
void basis_by_eigen(benchmark::State& state)
{
    constexpr int kDegree = 3;
    const Eigen::VectorXd inner = Eigen::VectorXd::LinSpaced(50, 0, 1);
    Eigen::VectorXd knots(inner.size() + 2 * kDegree);
    knots << Eigen::Vector3d::Zero(), inner, Eigen::Vector3d::Ones();
    const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(10'000, 0, 1);
    Eigen::Matrix4Xd ours(4, 2 * at.size()), library = ours;
    const auto by_ours = [&] {
        for (Index i = 0; i < at.size(); ++i) {
            const surface::BasisFunctions basis = surface::basis_functions(knots, kDegree, at[i]);
            ours.col(2 * i) = basis.value;
            ours.col(2 * i + 1) = basis.derivative;
        }
        return ours(0, 0);
    };
    const auto by_eigen = [&] {
        const Eigen::Array<double, 1, Eigen::Dynamic> row = knots.transpose().array();
        for (Index i = 0; i < at.size(); ++i)
            library.middleCols(2 * i, 2) =
                Eigen::Spline<double, 1>::BasisFunctionDerivatives(at[i], 1, kDegree, row).transpose();
        return library(0, 0);
    };
    race(state, by_ours, by_eigen);
    state.counters["difference"] = (ours - library).cwiseAbs().maxCoeff();
}
BENCHMARK(basis_by_eigen)->Unit(benchmark::kMillisecond);

// --- products of small matrices -------------------------------------------------------------------------------------

/// A mixture of processes of 30 touches on 170 control heights: what a fit multiplies for one correlation.
void product_by_eigen(benchmark::State& state)
{
    constexpr int kRepetitions = 1000;
    std::srand(1); // Eigen's random numbers
    const MatrixXd A = MatrixXd::Random(170, 30), B = MatrixXd::Random(30, 24), C = MatrixXd::Random(24, 170);
    MatrixXd ours, library;
    const auto repeated = [&](const auto& multiply) {
        return [&] {
            for (int k = 0; k < kRepetitions; ++k) multiply();
            return 0;
        };
    };
    race(state, repeated([&] { ours = core::product(core::product(A, B), C); }),
         repeated([&] { library = A * B * C; }));
    state.counters["difference"] = (ours - library).cwiseAbs().maxCoeff();
}
BENCHMARK(product_by_eigen)->Iterations(3)->Unit(benchmark::kMillisecond);

} // namespace
