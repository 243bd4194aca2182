#include "belt/path_links.h"

#include "belt/contact_path.h"
#include "cloud/poses.h"
#include "core/direction.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace fettle {
namespace path_links_test {

// Strokes of a few points at random places around a part, each with the outward direction of the place.
cloud::Cloud strokes_on(const Eigen::Matrix3Xd& part, int count)
{
    std::mt19937_64 engine(3);
    std::uniform_int_distribution<Eigen::Index> draw(0, part.cols() - 1);
    cloud::PosePath poses;
    Eigen::VectorXd pass(2 * count);
    for (int k = 0; k < count; ++k) {
        const Eigen::Vector3d p = part.col(draw(engine)), z = p.normalized();
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = core::rotation_between(Eigen::Vector3d::UnitZ(), z);
        for (const double along : {0.0, 1.0}) {
            pose.translation() = p + along * pose.linear().col(0);
            poses.push_back(pose);
            pass[poses.size() - 1] = k;
        }
    }
    cloud::Cloud path;
    path.xyz.resize(3, poses.size());
    cloud::set_poses(path, poses);
    cloud::set_field(path, "pass", pass);
    return path;
}

// A bent shell, as far from convex as its travel is from straight.
Eigen::Matrix3Xd shell()
{
    Eigen::Matrix3Xd points(3, 2000);
    std::mt19937_64 engine(4);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (auto p : points.colwise()) {
        const double u = 80 * draw(engine), v = 30 * draw(engine);
        p << u, v, 0.005 * u * u - 0.01 * v * v + 5 * draw(engine);
    }
    return points;
}

// A tool that lies above its tip stays off the part by the clearance on the whole travel, between its poses as well,
// where they are interpolated: every point of the part is that far below the plane through the tip. Reference: every
// point, one by one.
TEST(PathLinks, TravelIsClear)
{
    const Eigen::Matrix3Xd part = shell();
    const belt::LinkOptions options{.clearance = 12, .approach = 4, .spacing = 5};
    const cloud::Cloud linked = belt::link_strokes(strokes_on(part, 30), part, options);
    const cloud::PosePath poses = cloud::read_poses(linked);
    const std::vector<cloud::Motion> motions = cloud::read_motions(linked);
    double min = 1e9, longest = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        longest = std::max(longest, (poses[i].translation() - poses[i - 1].translation()).norm());
        if (motions[i] != cloud::Motion::travel) continue;
        const Eigen::Quaterniond q0(poses[i - 1].linear()), q1(poses[i].linear());
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const Eigen::Vector3d z = q0.slerp(share, q1) * Eigen::Vector3d::UnitZ();
            const Eigen::Vector3d tip = (1 - share) * poses[i - 1].translation() + share * poses[i].translation();
            min = std::min(min, tip.dot(z) - (part.transpose() * z).maxCoeff());
        }
    }
    EXPECT_GE(min, 12);
    EXPECT_LT(min, 12.6); // and not much farther where it is nearest
    EXPECT_LE(longest, 5 + 1e-4);
}

// What lies between strokes: on the axis of the stroke before up, and of the next one down; the strokes themselves
// stay.
TEST(PathLinks, LeadsAreAlongTheAxis)
{
    const Eigen::Matrix3Xd part = shell();
    const cloud::Cloud path = strokes_on(part, 5);
    const cloud::Cloud linked = belt::link_strokes(path, part, {});
    const cloud::PosePath given = cloud::read_poses(path), poses = cloud::read_poses(linked);
    const std::vector<cloud::Motion> motions = cloud::read_motions(linked);
    const Eigen::VectorXd stroke = cloud::read_strokes(linked);
    EXPECT_EQ(motions.front(), cloud::Motion::travel);
    EXPECT_EQ(motions.back(), cloud::Motion::lead);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (stroke[i] >= 0) {
            EXPECT_LT((poses[i].matrix() - given[kept].matrix()).cwiseAbs().maxCoeff(), 1e-4);
            EXPECT_EQ(stroke[i], std::floor(kept / 2.0));
            ++kept;
        }
        if (i > 0 && (motions[i] == cloud::Motion::approach || motions[i] == cloud::Motion::lead)) {
            const Eigen::Vector3d step = poses[i].translation() - poses[i - 1].translation();
            EXPECT_NEAR(step.cross(poses[i].linear().col(2)).norm(), 0, 1e-3 * step.norm());
        }
    }
    EXPECT_EQ(kept, given.size());
    EXPECT_THROW(belt::link_strokes(linked, part, {}), core::InputError); // joined already
    EXPECT_THROW(belt::link_strokes(path, Eigen::Matrix3Xd(3, 0), {}), core::InputError);
    EXPECT_EQ(belt::interpolate_path(linked, 100).size(), linked.size());
}

} // namespace path_links_test
} // namespace fettle
