// Compares the poses of fettle-merge with the true ones that merge-scans wrote beside its scans, a line a scan, CSV.
//
//     merge-check POSES.json
//
// scan,shift,turn_deg,chi,within: the error of the pose about the scan's centroid, mm and degrees; its Mahalanobis
// distance by the stated covariance over √6; how many of the six components lie within two standard deviations. The
// first scan that has a pose is the reference. A scan without a pose has only its name.
#include "align/rigid.h"
#include "json/document.h"

#include <Eigen/Dense>

#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>

using namespace fettle;

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    json::Reader report = json::Reader::open(argv[1]);
    std::optional<Eigen::Isometry3d> T_first_mesh;
    std::cout << "scan,shift,turn_deg,chi,within\n";
    for (json::Reader& scan : report.objects("scans")) {
        const std::string file = scan.text("file");
        if (scan.is_null_or_missing("matrix")) {
            std::cout << file << ",,,,\n";
            continue;
        }
        const std::string truth = file.substr(0, file.rfind('.')) + ".txt";
        const Eigen::Isometry3d T_mesh_scan(align::read_transform(truth));
        const Eigen::Isometry3d found(Eigen::Matrix4d(scan.matrix("matrix", 4)));
        if (!T_first_mesh) {
            T_first_mesh = found * T_mesh_scan.inverse();
            continue;
        }
        const Eigen::Isometry3d error = found * (*T_first_mesh * T_mesh_scan).inverse();
        const Eigen::Vector3d centre = scan.vector("centre", 3);
        const Eigen::AngleAxisd turn(error.linear());
        Eigen::Matrix<double, 6, 1> x;
        x << error * centre - centre, turn.angle() * turn.axis();
        const Eigen::MatrixXd covariance = scan.matrix("covariance", 6);
        const double squared = x.dot(covariance.ldlt().solve(x));
        const auto within = (x.array().abs() <= 2 * covariance.diagonal().array().sqrt()).count();
        std::cout << file << ',' << x.head<3>().norm() << ',' << turn.angle() * 180 / std::numbers::pi << ','
                  << std::sqrt(squared / 6) << ',' << within << '\n';
    }
}
