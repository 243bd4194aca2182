#include "belt/contact_path.h"

#include "belt/local_fit.h"
#include "cloud/neighbours.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace fettle {
namespace {

// So many surfels tell how fast a patch's parameters run, in so many equal pieces of either.
constexpr Eigen::Index kProbes = 10000;
constexpr int kPieces = 64;
// A width that is a whole number of steps but for what fits at the border are off, in steps.
constexpr double kWhole = 1e-3;
// Of single-precision places a decimetre away, in steps of a millimetre's tenth.
constexpr double kRounding = 1e-4;

/// One patch as a surface over (u, v).
class PatchSurface {
  public:
    PatchSurface(const Surfels& surfels, const ContactPathOptions& options) : patch_(options.patch)
    {
        std::vector<Eigen::Index> own;
        for (Eigen::Index i = 0; i < surfels.size(); ++i)
            if (surfels.patch[i] == patch_ && (!options.on_stock || !std::isnan(surfels.displacement[i])))
                own.push_back(i);
        if (own.empty()) throw InputError("there is no surfel of patch " + std::to_string(patch_));
        surfels_.position = surfels.position(Eigen::all, own);
        surfels_.normal = surfels.normal(Eigen::all, own);
        surfels_.radius = surfels.radius(own);
        surfels_.uv = surfels.uv(Eigen::all, own);
        surfels_.patch = surfels.patch(own);
        surfels_.displacement = surfels.displacement(own);
        if (!options.on_stock) surfels_.displacement.setZero();
        reach_ = surfels_.radius.maxCoeff();
        measure();
        Eigen::Matrix3Xd flat = Eigen::Matrix3Xd::Zero(3, surfels_.size());
        for (Eigen::Index i = 0; i < surfels_.size(); ++i)
            flat.col(i).head<2>() << length(0, surfels_.uv(0, i)), length(1, surfels_.uv(1, i));
        neighbours_.emplace(flat);
    }

    /// How wide the patch is along u (axis 0) or v (1), mm: no curve of that parameter is longer.
    double width(int axis) const { return lengths_[axis][kPieces]; }
    /// Nothing where the patch is not.
    /// @param place  lengths along u and v from their least values, mm
    std::optional<LocalFit> at(const Eigen::Vector2d& place) const
    {
        const std::vector<Eigen::Index> near = neighbours_->nearest({place.x(), place.y(), 0}, kFitCandidates);
        const Eigen::Vector2d uv(parameter(0, place.x()), parameter(1, place.y()));
        const std::optional<LocalFit> fit = local_fit(surfels_, patch_, uv, near);
        if (!fit) return std::nullopt;
        const bool there = std::any_of(near.begin(), near.end(), [&](Eigen::Index i) {
            return (surfels_.position.col(i) - fit->P).norm() <= reach_ * (1 + kCorner);
        });
        return there ? fit : std::nullopt;
    }

  private:
    // The corner of a lattice's cell is just within the radius of its middle.
    static constexpr double kCorner = 0.01;

    double parameter(int axis, double length) const
    {
        const Eigen::VectorXd& lengths = lengths_[axis];
        int piece = 0;
        while (piece + 1 < kPieces && lengths[piece + 1] < length) ++piece;
        const double share = (length - lengths[piece]) / (lengths[piece + 1] - lengths[piece]);
        return least_[axis] + (most_[axis] - least_[axis]) * (piece + std::clamp(share, 0.0, 1.0)) / kPieces;
    }

    double length(int axis, double parameter) const
    {
        const double at = (parameter - least_[axis]) / (most_[axis] - least_[axis]) * kPieces;
        const int piece = std::clamp(static_cast<int>(at), 0, kPieces - 1);
        return lengths_[axis][piece] + (at - piece) * (lengths_[axis][piece + 1] - lengths_[axis][piece]);
    }

    void measure()
    {
        least_ = surfels_.uv.rowwise().minCoeff();
        most_ = surfels_.uv.rowwise().maxCoeff();
        const Neighbours neighbours(surfels_.position);
        const Eigen::Index step = std::max<Eigen::Index>(1, surfels_.size() / kProbes);
        Eigen::Matrix2Xd speeds = Eigen::Matrix2Xd::Zero(2, kPieces);
        for (Eigen::Index i = 0; i < surfels_.size(); i += step) {
            const auto fit = local_fit(surfels_, patch_, surfels_.uv.col(i),
                                       neighbours.nearest(surfels_.position.col(i), kFitCandidates));
            if (!fit) continue;
            const Eigen::Vector2d speed(fit->P_u.norm(), fit->P_v.norm());
            const Eigen::Vector2d share = (surfels_.uv.col(i) - least_).cwiseQuotient(most_ - least_);
            for (int axis = 0; axis < 2; ++axis) {
                double& here = speeds(axis, std::clamp(static_cast<int>(share[axis] * kPieces), 0, kPieces - 1));
                here = std::max(here, speed[axis]);
            }
        }
        const Eigen::Vector2d most = speeds.rowwise().maxCoeff();
        if (!(most.minCoeff() > 0))
            throw InputError("too few surfels on patch " + std::to_string(patch_) + " for a path");
        for (int axis = 0; axis < 2; ++axis) {
            lengths_[axis] = Eigen::VectorXd::Zero(kPieces + 1);
            for (int k = 0; k < kPieces; ++k) {
                // Between probes the greatest speed may be a neighbouring piece's; without any it is taken for the
                // most.
                const int from = std::max(k - 1, 0), to = std::min(k + 1, kPieces - 1);
                const double found = speeds.row(axis).segment(from, to - from + 1).maxCoeff();
                const double speed = found > 0 ? found : most[axis];
                lengths_[axis][k + 1] = lengths_[axis][k] + speed * (most_[axis] - least_[axis]) / kPieces;
            }
        }
    }

    int patch_;
    Surfels surfels_;
    double reach_ = 0;
    Eigen::Vector2d least_, most_; ///< u, v
    Eigen::VectorXd lengths_[2];   ///< of u and v, up to the ends of their pieces
    std::optional<Neighbours> neighbours_;
};

/// Adds poses along legs in u or v.
class PathBuilder {
  public:
    PathBuilder(const PatchSurface& surface, const ContactPathOptions& options) : surface_(surface), options_(options)
    {
    }

    /// @param from, to  lengths along u and v, mm; one of them is the same
    void leg(const Eigen::Vector2d& from, const Eigen::Vector2d& to)
    {
        const auto steps_for = [&](double length) {
            return std::max(1.0, std::ceil(length / options_.spacing - 1e-9));
        };
        double steps = steps_for((to - from).norm());
        std::vector<std::optional<LocalFit>> fits = along(from, to, steps);
        // Lengths come from probes, which may have missed where the parameters run fastest.
        for (double longest = longest_step(fits); longest > options_.spacing * (1 + kRounding);
             longest = longest_step(fits)) {
            steps = std::max(steps_for(steps * longest), steps + 1);
            fits = along(from, to, steps);
        }
        for (const std::optional<LocalFit>& fit : fits)
            if (fit)
                add(*fit, to - from);
            else
                end_pass();
    }

    void end_pass()
    {
        if (open_) ++pass_;
        open_ = false;
    }

    ContactPath path;

  private:
    std::vector<std::optional<LocalFit>> along(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                               double steps) const
    {
        std::vector<std::optional<LocalFit>> fits;
        for (double k = 0; k <= steps; ++k) fits.push_back(surface_.at(from + (to - from) * (k / steps)));
        return fits;
    }

    static double longest_step(const std::vector<std::optional<LocalFit>>& fits)
    {
        double longest = 0;
        for (std::size_t k = 1; k < fits.size(); ++k)
            if (fits[k - 1] && fits[k]) longest = std::max(longest, (fits[k]->P - fits[k - 1]->P).norm());
        return longest;
    }

    void add(const LocalFit& fit, const Eigen::Vector2d& way)
    {
        const Eigen::Vector3d z = fit.n.normalized();
        const Eigen::Vector3d feed = way[0] * fit.P_u + way[1] * fit.P_v;
        const Eigen::Vector3d x = (feed - feed.dot(z) * z).normalized();
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() << x, z.cross(x), z;
        pose.translation() = fit.P + (options_.on_stock ? fit.D : 0) * z;
        path.poses.push_back(pose);
        path.pass.push_back(pass_);
        open_ = true;
    }

    const PatchSurface& surface_;
    const ContactPathOptions& options_;
    int pass_ = 0;
    bool open_ = false;
};

/// Where on a patch, from lengths (mm) along the rows and across them.
struct Rows {
    const PatchSurface& surface;
    int along, across; ///< axes

    Eigen::Vector2d width() const { return {surface.width(along), surface.width(across)}; }
    Eigen::Vector2d on_patch(const Eigen::Vector2d& place) const
    {
        Eigen::Vector2d lengths;
        lengths[along] = place.x();
        lengths[across] = place.y();
        return lengths;
    }
};

void add_rows(PathBuilder& builder, const Rows& rows, const ContactPathOptions& options)
{
    const Eigen::Vector2d width = rows.width();
    const int count = std::max(1, static_cast<int>(std::ceil(width.y() / options.step_over - kWhole)));
    for (int k = 0; k < count; ++k) {
        // In the middles of equal strips: each row works half a step to either side.
        const double across = width.y() * (k + 0.5) / count;
        const Eigen::Vector2d a = rows.on_patch({0, across}), b = rows.on_patch({width.x(), across});
        const bool back = k % 2 == 1 && !options.one_way;
        builder.leg(back ? b : a, back ? a : b);
        builder.end_pass();
    }
}

void add_spiral(PathBuilder& builder, const Rows& rows, double step)
{
    // Turns in the middles of equal frames, as rows.
    Eigen::Vector2d least = Eigen::Vector2d::Constant(step / 2), most = rows.width() - least;
    Eigen::Vector2d at = least;
    const auto go = [&](const Eigen::Vector2d& to) {
        builder.leg(rows.on_patch(at), rows.on_patch(to));
        at = to;
    };
    while (most.x() >= least.x() && most.y() >= least.y()) {
        go({most.x(), at.y()});
        least.y() += step;
        if (most.y() < least.y()) break;
        go({at.x(), most.y()});
        most.x() -= step;
        if (most.x() < least.x()) break;
        go({least.x(), at.y()});
        most.y() -= step;
        if (most.y() < least.y()) break;
        go({at.x(), least.y()});
        least.x() += step;
    }
}

} // namespace

ContactPath contact_path(const Surfels& surfels, const ContactPathOptions& options)
{
    const PatchSurface surface(surfels, options);
    PathBuilder builder(surface, options);
    const Rows rows = {surface, options.along_v ? 1 : 0, options.along_v ? 0 : 1};
    if (options.pattern == PathPattern::rows)
        add_rows(builder, rows, options);
    else
        add_spiral(builder, rows, options.step_over);
    return std::move(builder.path);
}

Eigen::Quaterniond slerp(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double share)
{
    // Below this angle sines of it and of its parts are in the ratio of the angles, to rounding.
    constexpr double kSmallAngle = 1e-8;
    const double cosine = from.dot(to);
    const double way = cosine < 0 ? -1 : 1; // q and -q are one orientation
    // The sine from the chord is exact where the cosine is near 1.
    const double angle = 2 * std::asin(std::min(1.0, (from.coeffs() - way * to.coeffs()).norm() / 2));
    double a = 1 - share, b = share;
    if (angle > kSmallAngle) {
        a = std::sin((1 - share) * angle) / std::sin(angle);
        b = std::sin(share * angle) / std::sin(angle);
    }
    return Eigen::Quaterniond((a * from.coeffs() + way * b * to.coeffs()).eval()).normalized();
}

Cloud interpolated(const Cloud& path, double spacing)
{
    const PosePath poses = path_poses(path);
    const Eigen::VectorXd pass =
        has_field(path, "pass") ? field(path, "pass") : Eigen::VectorXd(Eigen::VectorXd::Zero(path.size()));
    std::vector<Eigen::Index> from; // the point at or before each of the new ones
    std::vector<double> shares;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        double parts = 1;
        if (i + 1 < path.size() && pass[i] == pass[i + 1]) {
            const double length = (path.xyz.col(i + 1) - path.xyz.col(i)).norm();
            if (std::isfinite(length)) parts = std::max(1.0, std::ceil(length / spacing - 1e-6));
            if (parts > 1e8) throw InputError("a spacing so fine makes more than 100 million points");
        }
        for (double k = 0; k < parts; ++k) {
            from.push_back(i);
            shares.push_back(k / parts);
        }
    }
    Cloud dense = select(path, from);
    dense.comment = path.comment;
    PosePath between(from.size());
    for (std::size_t k = 0; k < from.size(); ++k) {
        const auto i = static_cast<std::size_t>(from[k]);
        between[k] = poses[i];
        if (shares[k] == 0) continue;
        between[k].translation() = (1 - shares[k]) * poses[i].translation() + shares[k] * poses[i + 1].translation();
        between[k].linear() =
            slerp(Eigen::Quaterniond(poses[i].linear()), Eigen::Quaterniond(poses[i + 1].linear()), shares[k])
                .toRotationMatrix();
    }
    for (const Field& given : path.fields) {
        if (given.count != 1 || given.type != 'F') continue;
        const Eigen::VectorXd values = field(path, given.name);
        Eigen::VectorXd lerped(dense.size());
        for (std::size_t k = 0; k < from.size(); ++k) {
            const double here = values[from[k]];
            lerped[static_cast<Eigen::Index>(k)] =
                shares[k] == 0 ? here : (1 - shares[k]) * here + shares[k] * values[from[k] + 1];
        }
        set_field(dense, given.name, lerped, given.size);
    }
    set_path(dense, between);
    return dense;
}

PosePath held_part(const PosePath& T_part_contact, const Eigen::Isometry3d& T_cell_wheel)
{
    const Eigen::AngleAxisd half(std::numbers::pi, Eigen::Vector3d::UnitX());
    PosePath T_cell_tool = T_part_contact;
    for (Eigen::Isometry3d& pose : T_cell_tool) {
        if (pose.translation().hasNaN()) continue;
        pose = T_cell_wheel * pose.inverse() * half;
    }
    return T_cell_tool;
}

} // namespace fettle
