// Virtual scans of a mesh from all around, each in a frame of its own: rays of a pinhole camera, with what hides behind
// other parts of the mesh missing, dropouts where the beam grazes, and noise along the beam.
//
//     merge-scans MESH SCANS POINTS NOISE SEED FOLDER [view]
//
// Writes FOLDER/01.pcd, … and FOLDER/01.txt, …, the true matrix mesh <- scan; lengths in mm. POINTS: about so many a
// scan. With `view` the files state the camera's place as VIEWPOINT.
#include "align/rigid.h"
#include "cloud/pcd.h"
#include "geometry/bounding_box.h"
#include "geometry/uniform_draws.h"
#include "mesh/mesh_file.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>

#include <cmath>
#include <fstream>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace fettle;

namespace {

// A beam that meets the surface more flatly than this is lost; up to twice this cosine some are.
constexpr double kMinCosine = 0.17;
constexpr double kDistanceRadii = 4; // of the camera from the middle of the mesh, in its radii
constexpr double kGoldenAngle = 2.399963229728653;

/// The camera's places lie on a spiral from above to somewhat below the horizon (Fibonacci's lattice on a sphere).
Eigen::Vector3d view_direction(int index, int count)
{
    constexpr double kHighest = 0.9, kLowest = -0.35;
    const double z = kHighest + (kLowest - kHighest) * (index + 0.5) / count, across = std::sqrt(1 - z * z);
    return {across * std::cos(kGoldenAngle * index), across * std::sin(kGoldenAngle * index), z};
}

Eigen::Isometry3d random_motion(std::mt19937_64& random, double reach)
{
    const auto normal = [&] { return geometry::draw_normal(random, 1); };
    // Declarations are evaluated in their order, the arguments of a call in one that the compiler chooses.
    const double qz = normal(), qy = normal(), qx = normal(), qw = normal();
    const double z = normal(), y = normal(), x = normal();
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
    motion.translation() = reach * Eigen::Vector3d(x, y, z);
    return motion;
}

/// What a camera sees from `origin`, in the mesh's frame. @param steps  rays along each side of the image
Eigen::Matrix3Xd seen_from(const mesh::MeshIndex& index, const Eigen::Vector3d& origin, const Eigen::Vector3d& middle,
                           double radius, int steps, double noise, std::mt19937_64& random)
{
    const Eigen::Vector3d forward = (middle - origin).normalized(), right = forward.unitOrthogonal();
    const Eigen::Vector3d down = forward.cross(right);
    std::vector<Eigen::Vector3d> hits;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double u = (i + geometry::draw_uniform(random)) / steps * 2 - 1;
            const double v = (j + geometry::draw_uniform(random)) / steps * 2 - 1;
            const Eigen::Vector3d ray = (middle + radius * (u * right + v * down) - origin).normalized();
            const double survives = geometry::draw_uniform(random), error = geometry::draw_normal(random, noise);
            const auto hit = index.cast(origin, ray);
            if (!hit) continue;
            const mesh::Triangle t = mesh::triangle_of(index.mesh(), hit->triangle);
            const Eigen::Vector3d first = t.col(1) - t.col(0), second = t.col(2) - t.col(0);
            const double cosine = -first.cross(second).normalized().dot(ray);
            if (cosine > kMinCosine * (1 + survives)) hits.push_back(hit->point + error * ray);
        }
    Eigen::Matrix3Xd points(3, hits.size());
    for (std::size_t k = 0; k < hits.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = hits[k];
    return points;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 7) return 2;
    const mesh::Mesh part = mesh::read_mesh(argv[1]);
    const int count = std::stoi(argv[2]);
    const double wanted = std::stod(argv[3]), noise = std::stod(argv[4]);
    std::mt19937_64 random(std::stoull(argv[5]));
    const std::string folder = argv[6];
    const mesh::MeshIndex index(part);
    const Eigen::AlignedBox3d box = geometry::bounding_box(part.vertices);
    const double radius = box.sizes().norm() / 2;
    for (int k = 0; k < count; ++k) {
        const Eigen::Vector3d origin = box.center() + kDistanceRadii * radius * view_direction(k, count);
        constexpr int kTrial = 60;
        std::mt19937_64 trial(1);
        const auto few = seen_from(index, origin, box.center(), radius, kTrial, noise, trial).cols();
        const int steps = static_cast<int>(kTrial * std::sqrt(wanted / static_cast<double>(few)));
        const Eigen::Isometry3d T_scan_mesh = random_motion(random, 2 * radius);
        cloud::Cloud scan;
        scan.xyz = T_scan_mesh * seen_from(index, origin, box.center(), radius, steps, noise, random);
        if (argc > 7) scan.view_origin = T_scan_mesh * origin;
        const std::string stem = folder + (k < 9 ? "/0" : "/") + std::to_string(k + 1);
        std::ofstream file(stem + ".pcd"), truth(stem + ".txt");
        cloud::write_pcd(file, scan, units::Units{});
        align::write_transform(truth, T_scan_mesh.inverse().matrix());
    }
}
