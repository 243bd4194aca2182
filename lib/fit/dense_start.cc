#include "fit/dense_start.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "fit/bspline.h"
#include "geometry/local_quadratic.h"
#include "geometry/quantiles.h"
#include "surface/spline_energy.h"

#include <algorithm>
#include <cmath>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Points sampled from each cell by each lane. A control height influences sixteen cells, so it still rests on more than
// fifty points where only one lane has points of a cell.
constexpr std::uint64_t kSamplesPerCell = 4;

std::uint64_t murmur_hash(std::uint64_t number) // finaliser of MurmurHash3 (Appleby): all bits depend on all bits
{
    number = (number ^ number >> 33) * 0xff51afd7ed558ccdULL;
    number = (number ^ number >> 33) * 0xc4ceb9fe1a85ec53ULL;
    return number ^ number >> 33;
}

/// At most kSamplesPerCell points of each cell, each point with the same probability.
struct Reservoir {
    std::vector<std::uint32_t> seen; ///< number of points offered to each cell
    std::vector<CellPoint> samples;  ///< kSamplesPerCell slots for each cell, of which the first `seen` are filled
    PointCounts counts;
    std::vector<CellPoint> block;

    void add(const CellPoint& point, std::uint64_t number)
    {
        const std::uint64_t before = seen[point.cell]++;
        const std::uint64_t slot = before < kSamplesPerCell ? before : (murmur_hash(number) >> 32) * (before + 1) >> 32;
        if (slot < kSamplesPerCell) samples[kSamplesPerCell * point.cell + slot] = point;
    }
};

std::vector<CellPoint> sample_cells(const DensePoints& points, PointCounts& counts)
{
    const std::size_t cells = points.cells.size();
    std::vector<Reservoir> lanes(kNumLanes);
    parallel_for_blocks(points.source, [&](std::size_t lane, std::size_t first, const cloud::PointBlock& block) {
        Reservoir& reservoir = lanes[lane];
        reservoir.seen.resize(cells);
        reservoir.samples.resize(kSamplesPerCell * cells);
        assign_cells(points, block, reservoir.block, reservoir.counts);
        for (std::size_t i = 0; i < reservoir.block.size(); ++i) reservoir.add(reservoir.block[i], first + i);
    });
    std::vector<CellPoint> samples;
    for (const Reservoir& lane : lanes) {
        counts += lane.counts;
        for (std::size_t cell = 0; cell < lane.seen.size(); ++cell)
            for (std::uint64_t k = 0; k < std::min<std::uint64_t>(lane.seen[cell], kSamplesPerCell); ++k)
                samples.push_back(lane.samples[kSamplesPerCell * cell + k]);
    }
    return samples;
}

/// Subtracts the quadratic of least squares from the points. @return  its coefficients
Eigen::Matrix<double, 6, 1> remove_trend(std::vector<CellPoint>& points, const surface::Bspline& grid,
                                         const std::string& name)
{
    const surface::QuadraticControlHeights frame = surface::quadratic_control_heights(grid);
    const Index cells_u = grid.heights.rows() - 3;
    MatrixXd A(points.size(), 6);
    VectorXd z(A.rows());
    for (Index i = 0; i < A.rows(); ++i) {
        const CellPoint& p = points[i];
        const double u = ((p.cell % cells_u + 0.5 + p.u) * grid.cell.x() - frame.middle.x()) / frame.half_side;
        const double v = ((p.cell / cells_u + 0.5 + p.v) * grid.cell.y() - frame.middle.y()) / frame.half_side;
        A.row(i) = geometry::quadratic_terms(u, v).transpose();
        z[i] = p.z;
    }
    // The columns are of the order of 1; single-precision coordinates leave less than this of a dependent one.
    constexpr double kRankTolerance = 1e-6;
    const core::LeastSquaresSolution trend = core::least_squares_by_qr(A, z, kRankTolerance);
    if (trend.rank < 6)
        throw core::InputError(name,
                               "touches lie on a conic section in x and y, which leaves the curvature undetermined");
    z -= A * trend.x;
    for (Index i = 0; i < A.rows(); ++i) points[i].z = z[i];
    return trend.x;
}

} // namespace

MatrixXd density_factors(const MatrixXd& weights)
{
    std::vector<double> positive;
    for (const double w : weights.reshaped())
        if (w > 0) positive.push_back(w);
    if (positive.empty()) return MatrixXd::Ones(weights.rows(), weights.cols());
    const double limit = kMaxDensityRatio * geometry::median(positive);
    return weights.unaryExpr([limit](double w) { return w > limit ? limit / w : 1; });
}

double rounding_variance(const DensePoints& points)
{
    const double rounding = points.max_abs_coordinate * std::numeric_limits<float>::epsilon() / 4; // 2^-25
    return rounding * rounding;
}

DenseStart estimate_dense_start(const DensePoints& points, const std::string& name)
{
    // Each level halves the cells as long as they hold enough points to distinguish the majority from outliers.
    constexpr double kMinCells = 6;
    constexpr double kPointsPerCell = 8;
    // Each re-weighting divides the influence of outliers by about the inlier-to-outlier ratio.
    constexpr int kReweightings = 3;
    constexpr int kFinestSteps = 2;             // the coarser levels are a good start
    constexpr double kMinResidualSigmas = 0.25; // smaller residuals have the same weight

    DenseStart start;
    std::vector<CellPoint> samples = sample_cells(points, start.counts);
    if (samples.empty())
        throw core::InputError(name, "none of the " + std::to_string(points.source.points) +
                                         " points lies inside the sampling boundary and outside the anomaly");
    start.trend = remove_trend(samples, points.grid, name);
    const Eigen::Array2d finest_counts = cell_counts(points.grid);
    const double finest = finest_counts.maxCoeff();
    VectorXd w = VectorXd::Ones(samples.size()), r(samples.size());
    for (double cells = std::min(kMinCells, finest);;) {
        const surface::Bspline zero =
            cells < finest ? with_cell_counts(points.grid, (finest_counts * (cells / finest)).round().max(2))
                           : points.grid;
        start.spline = zero;
        const std::vector<CellPoint> gridded = regrid(samples, points.grid, zero);
        const VectorXd zero_heights = zero.heights.reshaped();
        const SplineEnergy energy = spline_energy_matrix(zero);
        for (int step = 0; step < (cells < finest ? kReweightings : kFinestSteps); ++step) {
            CellMoments moments(zero);
            residuals(gridded, cell_polynomials(zero), r.data());
            moments.add(gridded, r.data(), w.data());
            const MatrixXd s = density_factors(moments.weights());
            const NormalEquations equations{moments.normal_matrix(zero, s), moments.right_side(s),
                                            moments.square_sum(s), moments.weights().cwiseProduct(s).sum(),
                                            rounding_variance(points)};
            // The finest grid takes most of the time, so its λ is optimised only once.
            const SmoothedSpline fit = cells < finest || step == 0
                                           ? smooth_spline_by_likelihood(equations, zero_heights, energy, start.lambda)
                                           : smooth_spline(equations, zero_heights, energy, start.lambda);
            start.spline.heights = fit.heights.reshaped(zero.heights.rows(), zero.heights.cols());
            start.lambda = fit.lambda;
            residuals(gridded, cell_polynomials(start.spline), r.data());
            start.sigma = std::max(geometry::median_absolute(r) / geometry::kNormalQuartile,
                                   std::sqrt(rounding_variance(points)));
            w = r.unaryExpr([&](double x) { return 1 / std::max(std::abs(x) / start.sigma, kMinResidualSigmas); });
        }
        if (cells == finest) return start;
        const double next = 2 * cells;
        cells = next < finest && samples.size() >= kPointsPerCell * next * next ? next : finest;
    }
}

} // namespace fettle::fit
