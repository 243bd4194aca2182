// Prints the signed distance of points from a mesh: signed-distance MESH < POINTS
#include "compare/signed_distance.h"
#include "core/error.h"
#include "mesh/mesh_file.h"

#include <exception>
#include <iostream>
#include <vector>

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::cerr << "usage: signed-distance MESH < POINTS (x y z, mm)\n";
        return 2;
    }
    try {
        std::vector<double> numbers;
        for (double number; std::cin >> number;) numbers.push_back(number);
        const auto count = static_cast<Eigen::Index>(numbers.size() / 3);
        const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Map(numbers.data(), 3, count);
        const fettle::compare::ErrorMap map =
            fettle::compare::signed_distance(points, fettle::mesh::read_mesh(argv[1]));
        for (const double error : map.error) std::cout << error << '\n';
    } catch (const std::exception& error) {
        std::cerr << "signed-distance: " << error.what() << '\n';
        return 2;
    }
}
