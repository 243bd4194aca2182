// Errors that a printer, a mould or a scanner adds to a part: a mesh or cloud becomes one that is
// warped, shrunk, noisy and not quite in its place.

#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "mesh/mesh_file.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <ostream>
#include <random>

using namespace fettle;

namespace {

// Waves in all directions: enough that their sum has no direction of its own.
constexpr int kWaves = 16;

struct Disturbance {
    double warp = 0, wavelength = 1; ///< standard deviation along z, mm
    double shrinkage = 0;            ///< share of every length, about the middle of the foot
    double noise = 0;                ///< standard deviation along z, of each point by itself, mm
    double shift = 0;                ///< standard deviation along each axis, mm
    double turn = 0;                 ///< standard deviation about each axis through the middle, rad
};

/// Gaussian in the limit of many waves, alike everywhere: equal waves of random direction and phase.
class Warp {
  public:
    Warp(const Disturbance& d, std::mt19937_64& random) : amplitude_(d.warp * std::sqrt(2.0 / kWaves))
    {
        std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
        for (int k = 0; k < kWaves; ++k) {
            const double direction = angle(random);
            waves_.col(k) << 2 * std::numbers::pi / d.wavelength *
                                 Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                angle(random);
        }
    }
    double operator()(const Eigen::Vector3d& point) const
    {
        double sum = 0;
        for (int k = 0; k < kWaves; ++k) sum += std::cos(waves_.col(k).head<2>().dot(point.head<2>()) + waves_(2, k));
        return amplitude_ * sum;
    }

  private:
    double amplitude_;
    Eigen::Matrix<double, 3, kWaves> waves_; ///< wave vector in x, y; phase
};

Eigen::Matrix3Xd disturbed(Eigen::Matrix3Xd points, const Disturbance& d, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Warp warp(d, random);
    const Eigen::Vector3d middle = geometry::finite_bounding_box(points).center(), foot(middle.x(), middle.y(), 0);
    Eigen::Vector3d turn, shift;
    for (int k = 0; k < 3; ++k) {
        turn[k] = d.turn * normal(random);
        shift[k] = d.shift * normal(random);
    }
    const double angle = turn.norm();
    const Eigen::AngleAxisd rotation(angle, angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitZ());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        Eigen::Vector3d p = points.col(i);
        p.z() += warp(p) + d.noise * normal(random);
        p = foot + (1 - d.shrinkage) * (p - foot);
        points.col(i) = rotation * (p - middle) + middle + shift;
    }
    return points;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Disturb a mesh or a cloud, as making and measuring it does.", [](cli::Tool& t) {
        const std::string& path = t.main_input("PART", "STL, or a PCD");
        const bool& is_cloud = t.flag("--cloud", "It is a PCD");
        const std::optional<units::Units::Length>& unit = t.length_unit("--file-units", "Of PART");
        const double& warp = t.number("--warp", 0, "MM", "Smooth error, standard deviation", core::Range::at_least(0));
        const double& wavelength = t.number("--wavelength", 25, "MM", "Of the warp", core::Range::positive());
        const double& shrinkage = t.number("--shrinkage", 0, "SHARE", "Of all lengths", core::Range::at_least(0));
        const double& noise =
            t.number("--noise", 0, "MM", "Of each point, standard deviation", core::Range::at_least(0));
        const double& shift =
            t.number("--shift", 0, "MM", "Along each axis, standard deviation", core::Range::at_least(0));
        const double& turn =
            t.number("--turn", 0, "DEG", "About each axis, standard deviation", core::Range::at_least(0));
        t.parse();

        const Disturbance d = {warp, wavelength, shrinkage, noise, shift, turn * std::numbers::pi / 180};
        const units::Units::Length length = unit.value_or(units::Units::Length::mm);
        if (is_cloud) {
            cloud::CloudFile file = cloud::read_cloud(path);
            file.cloud.xyz = disturbed(file.cloud.xyz, d, t.seed());
            cloud::write_pcd(t.output(), file.cloud, file.units);
        } else {
            mesh::Mesh mesh = mesh::read_mesh(path, length);
            mesh.vertices = disturbed(mesh.vertices, d, t.seed());
            mesh::write_stl(t.output(), mesh, length);
        }
        return cli::Verdict::yes;
    });
}
