// How many touches make a plane (Wang 2007, Table 4-2) and a line (4.4.2).

#include "cli/tool.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "fit/plane.h"
#include "surface/surface.h"
#include "tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <vector>

using namespace fettle;
using namespace fettle::study;

namespace {

// The rectangle and the number of trials of Table 4-2.
const Eigen::Vector2d kSize(5 * kInch, 4 * kInch);
constexpr int kTrials = 100;

/// The paper names neither the plane's inclination nor the direction of the error: either level, with an error along
/// z, or under 45 degrees, with errors along x, y and z.
struct Setup {
    std::string name;
    double slope; ///< along x and along y
    bool all_axes;
};
const std::array<Setup, 2> kSetups = {{{"level", 0, false}, {"tilted", std::sqrt(0.5), true}}};

double plane_at(const Setup& setup, const Eigen::Vector2d& xy) { return setup.slope * (xy.x() + xy.y()); }

Eigen::Matrix3Xd touch_plane(const Setup& setup, const Eigen::Matrix2Xd& xy, std::uint64_t seed)
{
    Eigen::Matrix3Xd touches = touch([&](const Eigen::Vector2d& p) { return plane_at(setup, p); }, xy, seed);
    if (setup.all_axes)
        for (int axis = 0; axis < 2; ++axis)
            touches.row(axis) +=
                sampling::draw_noise(kNoise, xy.cols(), seed_of(seed, static_cast<std::uint64_t>(axis + 1)));
    return touches;
}

/// Places in the rectangle, with at least `min_distance` between any two of them.
Eigen::Matrix2Xd places(Random& random, int count, double min_distance)
{
    Eigen::Matrix2Xd xy(2, count);
    for (int i = 0; i < count;) {
        xy.col(i) = random.in_box(Eigen::Vector2d::Zero(), kSize);
        const bool far = i == 0 || (xy.leftCols(i).colwise() - xy.col(i)).colwise().norm().minCoeff() >= min_distance;
        // restarted where the first ones leave no place for the next
        i = far ? i + 1 : 0;
    }
    return xy;
}

/// Largest error over the rectangle: of planes, at a corner.
double plane_error(const Setup& setup, Random& random, int count, double min_distance, std::uint64_t seed)
{
    fit::FitInput input;
    input.xyz = touch_plane(setup, places(random, count, min_distance), seed);
    input.roles = Eigen::VectorXi::Ones(count);
    input.job.surface = job::SurfaceType::plane;
    input.job.probe.accuracy = kNoise.amplitude;
    double largest = 0;
    const surface::Surface fitted = fit::fit_plane(input).surface;
    for (const Eigen::Vector2d& share : {Eigen::Vector2d(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const Eigen::Vector2d corner = share.cwiseProduct(kSize);
        largest = std::max(largest, std::abs(surface::height(fitted, corner) - plane_at(setup, corner)));
    }
    return largest / kInch;
}

/// As in the paper, a figure is the mean, the standard deviation or the largest of 100 trials; it is drawn many times,
/// so that one sees how much of it was luck.
void plane_row(std::ostream& out, const Setup& setup, const std::string& row, int count, double min_distance,
               int batches, std::uint64_t seed)
{
    const std::string name = "4-2/" + setup.name + "/" + row;
    Random random(seed);
    for (int batch = 0; batch < batches; ++batch) {
        Eigen::VectorXd errors(kTrials);
        for (int trial = 0; trial < kTrials;) {
            try {
                errors[trial] = plane_error(setup, random, count, min_distance,
                                            seed_of(seed, static_cast<std::uint64_t>(batch * kTrials + trial)));
                ++trial;
            } catch (const core::InputError&) {
                write(out, name + "/on_a_line", 1); // the fit refuses three touches on a line; the paper drew no others
            }
        }
        write(out, name + "/mean", errors.mean());
        write(out, name + "/sd", std::sqrt((errors.array() - errors.mean()).square().sum() / (kTrials - 1)));
        write(out, name + "/max", errors.maxCoeff());
    }
}

/// Largest error of the least-squares line through touches at these shares of a line as long as the rectangle.
double line_error(const Eigen::VectorXd& shares, std::uint64_t seed)
{
    Eigen::MatrixXd A(shares.size(), 2);
    A << Eigen::VectorXd::Ones(shares.size()), shares;
    const Eigen::Vector2d error = core::least_squares_by_qr(A, sampling::draw_noise(kNoise, shares.size(), seed)).x;
    return std::max(std::abs(error[0]), std::abs(error.sum())) / kInch;
}

void line_rows(std::ostream& out, int trials, std::uint64_t seed)
{
    Random random(seed);
    const auto draw = [&](int count, double min_distance) {
        Eigen::VectorXd shares(count);
        do
            for (double& share : shares) share = random.uniform(0, 1);
        while (shares.maxCoeff() - shares.minCoeff() < min_distance);
        return shares;
    };
    for (int trial = 0; trial < trials; ++trial) {
        const std::uint64_t own = seed_of(seed, static_cast<std::uint64_t>(trial));
        write(out, "line/random2", line_error(draw(2, 0), own));
        write(out, "line/apart2", line_error(draw(2, 0.5), own));
        write(out, "line/random3", line_error(draw(3, 0), own));
        write(out, "line/ends_and_middle", line_error(Eigen::Vector3d(0, 0.5, 1), own));
    }
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Planes and lines through few touches.", [](cli::Tool& t) {
        const int& batches = t.count("--batches", 200, "Of 100 trials each", 1, 100000);
        t.parse();

        std::ostream& out = t.output();
        for (const Setup& setup : kSetups) {
            for (int count = 3; count <= 6; ++count)
                plane_row(out, setup, "random" + std::to_string(count), count, 0, batches,
                          seed_of(t.seed(), static_cast<std::uint64_t>(count)));
            // half and two thirds of the shorter side
            plane_row(out, setup, "apart2", 3, 2 * kInch, batches, seed_of(t.seed(), 20));
            plane_row(out, setup, "apart2.67", 3, 2.67 * kInch, batches, seed_of(t.seed(), 27));
        }
        line_rows(out, batches * kTrials, seed_of(t.seed(), 1));
        return cli::Verdict::yes;
    });
}
