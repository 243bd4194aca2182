#include "fit/dense_start.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "surface/spline_energy.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of each cell in each lane. Sixteen basis functions overlap in a cell, so that a control height still rests on more
// than fifty points where a cell is seen by one lane only.
constexpr std::uint64_t kDrawn = 4;

std::uint64_t mixed(std::uint64_t number) // finaliser of MurmurHash3 (Appleby): all bits depend on all bits
{
    number = (number ^ number >> 33) * 0xff51afd7ed558ccdULL;
    number = (number ^ number >> 33) * 0xc4ceb9fe1a85ec53ULL;
    return number ^ number >> 33;
}

/// At most kDrawn points of each cell, any of them with the same chance.
struct Reservoir {
    std::vector<std::uint32_t> seen; ///< of each cell
    std::vector<CellPoint> drawn;    ///< kDrawn of each cell, the first min(seen, kDrawn) of them
    PointCounts counts;
    std::vector<CellPoint> block;

    void add(const CellPoint& point, std::uint64_t number)
    {
        const auto cell = static_cast<std::size_t>(point.cell);
        const std::uint64_t before = seen[cell]++;
        const std::uint64_t place = before < kDrawn ? before : (mixed(number) >> 32) * (before + 1) >> 32;
        if (place < kDrawn) drawn[kDrawn * cell + place] = point;
    }
};

std::vector<CellPoint> draw(const DensePoints& points, PointCounts& counts)
{
    const std::size_t cells = points.cells.size();
    std::vector<Reservoir> lanes(kBlockLanes);
    for_blocks(points.source, [&](std::size_t lane, std::size_t first, const PointBlock& block) {
        Reservoir& reservoir = lanes[lane];
        reservoir.seen.resize(cells);
        reservoir.drawn.resize(kDrawn * cells);
        locate(points, block, reservoir.block, reservoir.counts);
        for (std::size_t i = 0; i < reservoir.block.size(); ++i) reservoir.add(reservoir.block[i], first + i);
    });
    std::vector<CellPoint> drawn;
    for (const Reservoir& lane : lanes) {
        counts += lane.counts;
        for (std::size_t cell = 0; cell < lane.seen.size(); ++cell)
            for (std::uint64_t k = 0; k < std::min<std::uint64_t>(lane.seen[cell], kDrawn); ++k)
                drawn.push_back(lane.drawn[kDrawn * cell + k]);
    }
    return drawn;
}

Bspline with_cells(const Bspline& grid, double cells)
{
    const Eigen::Vector2d old(static_cast<double>(grid.heights.rows() - 3),
                              static_cast<double>(grid.heights.cols() - 3));
    const Eigen::Vector2d counts = (old * (cells / old.maxCoeff())).array().round().max(2);
    Bspline coarse{grid.angle, grid.origin, grid.cell.cwiseProduct(old).cwiseQuotient(counts), {}};
    coarse.heights.setZero(static_cast<Index>(counts.x()) + 3, static_cast<Index>(counts.y()) + 3);
    return coarse;
}

/// Takes the quadratic of least squares off the points.
Eigen::Matrix<double, 6, 1> take_trend(std::vector<CellPoint>& points, const Bspline& grid, const std::string& name)
{
    const Quadratics known = quadratics(grid);
    const Index cells_u = grid.heights.rows() - 3;
    MatrixXd A(static_cast<Index>(points.size()), 6);
    VectorXd z(A.rows());
    for (Index i = 0; i < A.rows(); ++i) {
        const CellPoint& p = points[static_cast<std::size_t>(i)];
        const double u =
            ((static_cast<double>(p.cell % cells_u) + 0.5 + p.u) * grid.cell.x() - known.middle.x()) / known.half;
        const double v =
            ((static_cast<double>(p.cell / cells_u) + 0.5 + p.v) * grid.cell.y() - known.middle.y()) / known.half;
        A.row(i) << 1, u, v, u * u, u * v, v * v;
        z[i] = p.z;
    }
    // Columns are of the order of 1; coordinates in F4 leave this much of one that is not there.
    constexpr double kRounding = 1e-6;
    const LeastSquares trend = least_squares_by_qr(A, z, kRounding);
    if (trend.rank < 6)
        throw InputError(name, "touches lie on a conic section in x and y, which leaves the curvature open");
    z -= A * trend.x;
    for (Index i = 0; i < A.rows(); ++i) points[static_cast<std::size_t>(i)].z = z[i];
    return trend.x;
}

/// Standard deviation of normal residuals by their median, which outliers hardly move.
double median_sigma(VectorXd r)
{
    constexpr double kQuartile = 0.6744897501960817; // of the normal distribution
    double* middle = r.data() + r.size() / 2;
    std::nth_element(r.data(), middle, r.data() + r.size(),
                     [](double a, double b) { return std::abs(a) < std::abs(b); });
    return std::abs(*middle) / kQuartile;
}

} // namespace

MatrixXd density_factors(const MatrixXd& weights)
{
    std::vector<double> some;
    for (const double w : weights.reshaped())
        if (w > 0) some.push_back(w);
    if (some.empty()) return MatrixXd::Ones(weights.rows(), weights.cols());
    std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2), some.end());
    const double most = kDensest * some[some.size() / 2];
    return weights.unaryExpr([most](double w) { return w > most ? most / w : 1; });
}

double rounding_variance(const DensePoints& points)
{
    const double rounding = points.largest * std::numeric_limits<float>::epsilon() / 4; // 2^-25
    return rounding * rounding;
}

DenseStart dense_start(const DensePoints& points, const std::string& name)
{
    // A level halves the cells as long as there are enough points in each for the majority to be told from the rest.
    constexpr double kCoarsest = 6;
    constexpr double kPointsPerCell = 8;
    // Each step divides the pull of outliers by about the odds against them.
    constexpr int kSteps = 3;
    constexpr int kFinestSteps = 2;  // begun near the end
    constexpr double kLinear = 0.25; // of sigma: smaller residuals weigh alike

    DenseStart start;
    std::vector<CellPoint> drawn = draw(points, start.counts);
    if (drawn.empty())
        throw InputError(name, "none of the " + std::to_string(points.source.points) +
                                   " points lies inside the sampling boundary and outside the anomaly");
    start.trend = take_trend(drawn, points.grid, name);
    const double finest = static_cast<double>(std::max(points.grid.heights.rows(), points.grid.heights.cols()) - 3);
    const auto size = static_cast<Index>(drawn.size());
    VectorXd w = VectorXd::Ones(size), r(size);
    std::vector<CellPoint> here;
    for (double cells = std::min(kCoarsest, finest);;) {
        start.spline = cells < finest ? with_cells(points.grid, cells) : points.grid;
        relocate(drawn, points.grid, start.spline, here);
        const Bspline zero = start.spline;
        const VectorXd nothing = zero.heights.reshaped();
        const Energy energy = energy_over(zero);
        for (int step = 0; step < (cells < finest ? kSteps : kFinestSteps); ++step) {
            CellMoments moments(zero);
            residuals(here, cell_polynomials(zero), r.data());
            moments.add(here, r.data(), w.data());
            const MatrixXd s = density_factors(moments.weights());
            const NormalEquations equations{moments.matrix(zero, s), moments.right(s), moments.square(s),
                                            moments.weights().cwiseProduct(s).sum(), rounding_variance(points)};
            // The finest grid is what takes time: its λ is looked for once.
            const Smoothed fit = cells < finest || step == 0
                                     ? smoothed_by_likelihood(equations, nothing, energy, start.lambda)
                                     : smoothed(equations, nothing, energy, start.lambda);
            start.spline.heights = fit.heights.reshaped(zero.heights.rows(), zero.heights.cols());
            start.lambda = fit.lambda;
            residuals(here, cell_polynomials(start.spline), r.data());
            start.sigma = std::max(median_sigma(r), std::sqrt(rounding_variance(points)));
            w = r.unaryExpr([&](double x) { return 1 / std::max(std::abs(x) / start.sigma, kLinear); });
        }
        if (cells == finest) return start;
        const double next = 2 * cells;
        cells = next < finest && static_cast<double>(size) >= kPointsPerCell * next * next ? next : finest;
    }
}

} // namespace fettle
