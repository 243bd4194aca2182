#include "belt/path_links.h"

#include "cloud/poses.h"
#include "core/constants.h"
#include "core/error.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::belt {

namespace {

using cloud::Motion, Eigen::Isometry3d, Eigen::Vector3d;

// Maximum turn of the tool from point to point of a travel, rad: what a chord of the support function misses grows with
// its square, and so does the way of the tip off the straight line while the joints move evenly.
constexpr double kMaxTurn = 1.5 * core::kRadPerDegree;
// Rounding of a number of steps.
constexpr double kSpacingTolerance = 1e-9;
// Maximum number of points between two strokes.
constexpr double kMaxLinkPoints = 1e5;

/// A path under construction: poses, with the point of the given path whose other fields they have.
struct LinkedPath {
    cloud::PosePath poses;
    std::vector<Eigen::Index> source;
    std::vector<double> stroke, motion;

    void add(const Isometry3d& pose, Eigen::Index from, double in_stroke, Motion kind)
    {
        poses.push_back(pose);
        source.push_back(from);
        stroke.push_back(in_stroke);
        motion.push_back(static_cast<double>(kind));
    }
};

Isometry3d lifted(Isometry3d pose, double height)
{
    pose.translation() += height * pose.linear().col(2);
    return pose;
}

class Linker {
  public:
    Linker(const Eigen::Matrix3Xd& part, const LinkOptions& options) : options_(options)
    {
        for (const auto p : part.colwise())
            if (p.allFinite()) points_.push_back(p);
        if (points_.empty()) throw core::InputError("the part has no point");
        extent_ = geometry::finite_bounding_box(part).diagonal().norm() + options.clearance + options.approach;
    }

    /// From a contact up to below the top over it.
    void add_retract(LinkedPath& path, const Isometry3d& contact, Eigen::Index source) const
    {
        for (const double height : heights_below_top(contact))
            path.add(lifted(contact, height), source, -1,
                     height <= options_.approach ? Motion::approach : Motion::lead);
    }

    /// From below the top over a contact down to it, without the contact.
    void add_approach(LinkedPath& path, const Isometry3d& contact, Eigen::Index source) const
    {
        std::vector<double> heights = heights_below_top(contact);
        std::ranges::reverse(heights);
        for (const double height : heights)
            path.add(lifted(contact, height), source, -1, height < options_.approach ? Motion::approach : Motion::lead);
    }

    /// The top over a contact: the highest point of its retract and of its approach.
    void add_top(LinkedPath& path, const Isometry3d& contact, Eigen::Index source, Motion motion) const
    {
        path.add(lifted(contact, top_height(contact)), source, -1, motion);
    }

    /// From the top over one contact, where the tool is already, to the top over the next.
    void add_travel(LinkedPath& path, const Isometry3d& from, const Isometry3d& to, Eigen::Index source) const
    {
        const Isometry3d start = lifted(from, top_height(from)), end = lifted(to, top_height(to));
        const Eigen::Quaterniond q0(start.linear()), q1(end.linear());
        double steps = std::max({1.0, std::ceil(q0.angularDistance(q1) / kMaxTurn),
                                 std::ceil((end.translation() - start.translation()).norm() / options_.spacing)});
        cloud::PosePath poses = travel(start, end, steps);
        for (double longest = longest_step(poses); longest > options_.spacing && steps < kMaxLinkPoints;
             longest = longest_step(poses)) {
            steps = std::ceil(steps * std::max(longest / options_.spacing, 1.1));
            poses = travel(start, end, steps);
        }
        for (std::size_t k = 1; k < poses.size(); ++k) path.add(poses[k], source, -1, Motion::travel);
    }

  private:
    double support(const Vector3d& direction) const
    {
        double max = -core::kInfinity;
        for (const Vector3d& p : points_) max = std::max(max, p.dot(direction));
        return max;
    }

    // By how much a tip must be lifted along its axis. Between two points of the travel at most s apart whose axes
    // differ by d the height over a point of the part at a distance D falls short of the interpolated one by at most
    // D d² / 8 + s d / 4.
    double missing_height(const Isometry3d& pose) const
    {
        const Vector3d z = pose.linear().col(2);
        const double between = extent_ * kMaxTurn * kMaxTurn / 8 + options_.spacing * kMaxTurn / 4;
        return support(z) + options_.clearance + options_.uncertainty + between - pose.translation().dot(z);
    }

    double top_height(const Isometry3d& contact) const { return std::max(missing_height(contact), options_.approach); }

    /// Heights of the points over a contact, upwards: the height of the approach among them, the top not.
    std::vector<double> heights_below_top(const Isometry3d& contact) const
    {
        const double top = top_height(contact);
        std::vector<double> list;
        for (const auto& [from, to] : {std::pair(0.0, options_.approach), std::pair(options_.approach, top)}) {
            const double steps = std::ceil((to - from) / options_.spacing - kSpacingTolerance);
            if (!(steps <= kMaxLinkPoints)) throw core::InputError("the spacing between strokes is too fine");
            for (double k = 1; k <= steps; ++k) list.push_back(from + (to - from) * (k / steps));
        }
        if (!list.empty()) list.pop_back();
        return list;
    }

    cloud::PosePath travel(const Isometry3d& start, const Isometry3d& end, double steps) const
    {
        const Eigen::Quaterniond q0(start.linear()), q1(end.linear());
        cloud::PosePath poses;
        for (double k = 0; k <= steps; ++k) {
            const double share = k / steps;
            Isometry3d pose = Isometry3d::Identity();
            pose.linear() = q0.slerp(share, q1).toRotationMatrix();
            pose.translation() = (1 - share) * start.translation() + share * end.translation();
            poses.push_back(k == 0 ? start : k == steps ? end : lifted(pose, std::max(missing_height(pose), 0.0)));
        }
        return poses;
    }

    static double longest_step(const cloud::PosePath& poses)
    {
        double longest = 0;
        for (std::size_t k = 1; k < poses.size(); ++k)
            longest = std::max(longest, (poses[k].translation() - poses[k - 1].translation()).norm());
        return longest;
    }

    const LinkOptions& options_;
    std::vector<Vector3d> points_;
    double extent_ = 0; ///< bound of the distance of a tip that moves on the part's hull from a point of it, mm
};

struct Stroke {
    Eigen::Index first, last;
};

std::vector<Stroke> find_strokes(const cloud::Cloud& path, const cloud::PosePath& poses)
{
    const Eigen::VectorXd number = cloud::read_strokes(path);
    std::vector<Stroke> strokes;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        if (poses[i].translation().hasNaN()) continue;
        if (cloud::has_field(path, "stroke") && number[i] < 0)
            throw core::InputError("the strokes of the path are joined already");
        if (!strokes.empty() && strokes.back().last == i - 1 && number[i] == number[i - 1])
            strokes.back().last = i;
        else
            strokes.push_back({i, i});
    }
    if (strokes.empty()) throw core::InputError("the path has no pose");
    return strokes;
}

cloud::Cloud to_cloud(const LinkedPath& linked, const cloud::Cloud& path)
{
    cloud::Cloud cloud = cloud::select_points(path, linked.source);
    cloud.comment = path.comment;
    cloud::set_poses(cloud, linked.poses);
    const auto values = [](const std::vector<double>& list) { return Eigen::VectorXd::Map(list.data(), list.size()); };
    Eigen::VectorXd pass = cloud::has_field(cloud, "pass") ? cloud::field(cloud, "pass") : values(linked.stroke);
    for (Eigen::Index i = 0; i < pass.size(); ++i)
        if (linked.stroke[i] < 0) pass[i] = -1;
    cloud::set_field(cloud, "pass", pass);
    cloud::set_field(cloud, "stroke", values(linked.stroke));
    cloud::set_field(cloud, "motion", values(linked.motion));
    return cloud;
}

} // namespace

cloud::Cloud link_strokes(const cloud::Cloud& path, const Eigen::Matrix3Xd& part, const LinkOptions& options)
{
    const cloud::PosePath poses = cloud::read_poses(path);
    const std::vector<Stroke> strokes = find_strokes(path, poses);
    const Linker linker(part, options);
    LinkedPath linked;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        const auto& [first, last] = strokes[k];
        if (k == 0)
            linker.add_top(linked, poses[first], first, Motion::travel);
        else
            linker.add_travel(linked, poses[strokes[k - 1].last], poses[first], first);
        linker.add_approach(linked, poses[first], first);
        for (Eigen::Index i = first; i <= last; ++i)
            linked.add(poses[i], i, static_cast<double>(k), i == first ? Motion::approach : Motion::stroke);
        linker.add_retract(linked, poses[last], last);
        linker.add_top(linked, poses[last], last, Motion::lead);
    }
    return to_cloud(linked, path);
}

} // namespace fettle::belt
