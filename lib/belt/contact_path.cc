#include "belt/contact_path.h"

#include "belt/patch_surface.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>

namespace fettle::belt {
namespace {

// Fraction of a step by which the width may exceed a whole number of steps: the fits at the border are off by less.
constexpr double kWidthToleranceSteps = 1e-3;
// Rounding of single-precision coordinates of a decimetre, relative to a step of a tenth of a millimetre.
constexpr double kRelativeRounding = 1e-4;
// Points of a path: 2 GB with what is computed beside them, and days of grinding.
constexpr double kMaxPathPoints = 5e6;

void check_point_count(double count)
{
    if (!(count <= kMaxPathPoints)) throw core::InputError("the spacing is too fine: more than 5 million points");
}

/// Appends poses along lines of constant u or v. Its coordinates are lengths along and across the rows, mm.
class PathBuilder {
  public:
    PathBuilder(const PatchSurface& surface, const ContactPathOptions& options) : surface_(surface), options_(options)
    {
    }

    /// Width of the patch along and across the rows.
    Eigen::Vector2d width() const { return swapped({surface_.width(0), surface_.width(1)}); }

    /// @param start, end  in a row, or across the rows
    void add_line(const Eigen::Vector2d& start, const Eigen::Vector2d& end)
    {
        const Eigen::Vector2d from = swapped(start), to = swapped(end);
        const auto steps_for = [&](double length) {
            return std::max(1.0, std::ceil(length / options_.spacing - 1e-9));
        };
        double steps = steps_for((to - from).norm());
        std::vector<std::optional<LocalFit>> fits = fits_along(from, to, steps);
        // The table of lengths is sampled and may have missed the maximum speed.
        for (double longest = longest_step(fits); longest > options_.spacing * (1 + kRelativeRounding);
             longest = longest_step(fits)) {
            steps = std::max(steps_for(steps * longest), steps + 1);
            fits = fits_along(from, to, steps);
        }
        for (const std::optional<LocalFit>& fit : fits)
            if (fit)
                add_pose(*fit, to - from);
            else
                end_pass();
    }

    void end_pass()
    {
        if (is_in_pass_) ++pass_;
        is_in_pass_ = false;
    }

    ContactPath path;

  private:
    /// Converts between (along, across) and (u, v).
    Eigen::Vector2d swapped(const Eigen::Vector2d& p) const { return options_.along_v ? p.reverse().eval() : p; }

    std::vector<std::optional<LocalFit>> fits_along(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                                    double steps) const
    {
        check_point_count(static_cast<double>(path.poses.size()) + steps);
        std::vector<std::optional<LocalFit>> fits;
        for (double k = 0; k <= steps; ++k) fits.push_back(surface_.fit_at(from + (to - from) * (k / steps)));
        return fits;
    }

    static double longest_step(const std::vector<std::optional<LocalFit>>& fits)
    {
        double longest = 0;
        for (std::size_t k = 1; k < fits.size(); ++k)
            if (fits[k - 1] && fits[k]) longest = std::max(longest, (fits[k]->P - fits[k - 1]->P).norm());
        return longest;
    }

    void add_pose(const LocalFit& fit, const Eigen::Vector2d& direction)
    {
        const Eigen::Vector3d z = fit.n.normalized();
        const bool is_fixed = options_.orientation == PathOrientation::fixed;
        const Eigen::Vector2d towards = is_fixed ? swapped(Eigen::Vector2d::UnitX()) : direction;
        const Eigen::Vector3d feed = towards[0] * fit.P_u + towards[1] * fit.P_v;
        const Eigen::Vector3d x = (feed - feed.dot(z) * z).normalized();
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() << x, z.cross(x), z;
        pose.translation() = fit.P + (options_.on_stock ? fit.D : 0) * z;
        path.poses.push_back(pose);
        path.pass.push_back(pass_);
        is_in_pass_ = true;
    }

    const PatchSurface& surface_;
    const ContactPathOptions& options_;
    int pass_ = 0;
    bool is_in_pass_ = false;
};

void check_row_count(double count)
{
    constexpr double kMaxRows = 1e5; // of some points each
    if (!(count <= kMaxRows)) throw core::InputError("the step-over is too fine: more than 100,000 rows");
}

void add_rows(PathBuilder& builder, const ContactPathOptions& options)
{
    const Eigen::Vector2d width = builder.width();
    const double rows = std::ceil(width.y() / options.step_over - kWidthToleranceSteps);
    check_row_count(rows);
    const int count = std::max(1, static_cast<int>(rows));
    for (int k = 0; k < count; ++k) {
        // Rows are the centre lines of equal strips.
        const double across = width.y() * (k + 0.5) / count;
        const Eigen::Vector2d a(0, across), b(width.x(), across);
        const bool is_reversed = k % 2 == 1 && !options.one_way;
        builder.add_line(is_reversed ? b : a, is_reversed ? a : b);
        builder.end_pass();
    }
}

void add_spiral(PathBuilder& builder, double step)
{
    check_row_count(builder.width().minCoeff() / step);
    // Turns are the centre lines of equal frames. Each side moves the border along which the previous one ran inwards.
    Eigen::Vector2d min = Eigen::Vector2d::Constant(step / 2), max = builder.width() - min;
    Eigen::Vector2d position = min;
    for (int side = 0; max.x() >= min.x() && max.y() >= min.y(); side = (side + 1) % 4) {
        const int axis = side % 2, other = 1 - axis;
        Eigen::Vector2d end = position;
        end[axis] = side < 2 ? max[axis] : min[axis];
        builder.add_line(position, end);
        position = end;
        if (side == 0 || side == 3)
            min[other] += step;
        else
            max[other] -= step;
    }
}

ContactPath path_over_patch(const Surfels& surfels, const ContactPathOptions& options)
{
    const PatchSurface surface(surfels, options.patch, options.on_stock);
    PathBuilder builder(surface, options);
    if (options.pattern == PathPattern::rows)
        add_rows(builder, options);
    else
        add_spiral(builder, options.step_over);
    return std::move(builder.path);
}

/// The lines u of two patches may run opposite ways: turns the tool by half a turn on a path if its first pose is then
/// nearer to that of the path before it.
void keep_side(const cloud::PosePath& before, cloud::PosePath& poses)
{
    if (before.empty() || poses.empty()) return;
    const Eigen::Isometry3d half_turn(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond last(before.back().linear()), as_is(poses.front().linear()),
        turned((poses.front() * half_turn).linear());
    if (last.angularDistance(turned) >= last.angularDistance(as_is)) return;
    for (Eigen::Isometry3d& pose : poses) pose = pose * half_turn;
}

} // namespace

ContactPath contact_path(const Surfels& surfels, const ContactPathOptions& options)
{
    if (options.patch != kAllPatches) return path_over_patch(surfels, options);
    const std::set<int> patches(surfels.patch.begin(), surfels.patch.end());
    if (patches.empty()) throw core::InputError("no surfels");
    ContactPath whole;
    for (const int patch : patches) {
        ContactPathOptions options_of_patch = options;
        options_of_patch.patch = patch;
        try {
            ContactPath path = path_over_patch(surfels, options_of_patch);
            if (options.orientation == PathOrientation::fixed) keep_side(whole.poses, path.poses);
            const int first_pass = whole.pass.empty() ? 0 : whole.pass.back() + 1;
            whole.poses.insert(whole.poses.end(), path.poses.begin(), path.poses.end());
            for (const int pass : path.pass) whole.pass.push_back(first_pass + pass);
        } catch (const PatchTooSmall&) {
            whole.skipped_patches.push_back(patch);
            if (whole.skipped_patches.size() == patches.size()) throw;
        }
    }
    return whole;
}

cloud::Cloud interpolate_path(const cloud::Cloud& path, double spacing)
{
    const cloud::PosePath poses = cloud::read_poses(path);
    const Eigen::VectorXd pass = cloud::has_field(path, "pass") ? cloud::field(path, "pass")
                                                                : Eigen::VectorXd(Eigen::VectorXd::Zero(path.size()));
    const std::vector<cloud::Motion> motions = cloud::read_motions(path);
    std::vector<Eigen::Index> from; // index of the given point at or before each new point
    std::vector<double> shares;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        double parts = 1;
        if (i + 1 < path.size() && pass[i] == pass[i + 1] && motions[i + 1] == cloud::Motion::stroke) {
            const double length = (path.xyz.col(i + 1) - path.xyz.col(i)).norm();
            if (std::isfinite(length)) parts = std::max(1.0, std::ceil(length / spacing - 1e-6));
        }
        check_point_count(static_cast<double>(from.size()) + parts);
        for (double k = 0; k < parts; ++k) {
            from.push_back(i);
            shares.push_back(k / parts);
        }
    }
    cloud::Cloud dense = cloud::select_points(path, from);
    dense.comment = path.comment;
    cloud::PosePath dense_poses(from.size());
    for (std::size_t k = 0; k < from.size(); ++k) {
        const Eigen::Index i = from[k];
        dense_poses[k] = poses[i];
        if (shares[k] == 0) continue;
        dense_poses[k].translation() =
            (1 - shares[k]) * poses[i].translation() + shares[k] * poses[i + 1].translation();
        dense_poses[k].linear() = Eigen::Quaterniond(poses[i].linear())
                                      .slerp(shares[k], Eigen::Quaterniond(poses[i + 1].linear()))
                                      .toRotationMatrix();
    }
    for (const cloud::Field& source : path.fields) {
        if (source.count != 1 || source.type != 'F' || source.name == "motion") continue;
        const Eigen::VectorXd values = cloud::field(path, source.name);
        Eigen::VectorXd lerped(dense.size());
        for (std::size_t k = 0; k < from.size(); ++k) {
            const double value = values[from[k]];
            lerped[k] = shares[k] == 0 ? value : (1 - shares[k]) * value + shares[k] * values[from[k] + 1];
        }
        cloud::set_field(dense, source.name, lerped, source.size);
    }
    if (cloud::has_field(dense, "motion")) {
        Eigen::VectorXd motion = cloud::field(dense, "motion");
        for (std::size_t k = 0; k < from.size(); ++k)
            if (shares[k] != 0) motion[k] = static_cast<double>(cloud::Motion::stroke);
        cloud::set_field(dense, "motion", motion);
    }
    cloud::set_poses(dense, dense_poses);
    return dense;
}

Eigen::VectorXd way_along(const cloud::PosePath& poses)
{
    Eigen::VectorXd way = Eigen::VectorXd::Zero(poses.size());
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
        way[i] = way[i - 1] + (std::isnan(step) ? 0 : step);
    }
    return way;
}

cloud::PosePath held_part_path(const cloud::PosePath& T_part_contact, const Eigen::Isometry3d& T_cell_wheel)
{
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
    cloud::PosePath T_cell_tool = T_part_contact;
    for (Eigen::Isometry3d& pose : T_cell_tool) {
        if (pose.translation().hasNaN()) continue;
        pose = T_cell_wheel * pose.inverse() * half_turn;
    }
    return T_cell_tool;
}

} // namespace fettle::belt
