// What fettle-find finds of what is known to be there:    find-score PART.pcd [--against REF]
//
// PART has fields `truth` (0, or the number of the anomaly that a point is on) and `truth_height` (over the surface
// beneath). A line for each anomaly: "true", number, points, height in noise, width in cells (the largest inscribed
// circle's diameter), intersection over union of the points with the best find's, share of the points outside of that
// find's B, its probability; then one for each find: "find", right (1: 0.3 of its points are on an anomaly),
// probability, height, area, score, doubtful others, doubt; then "run", noise, seconds.
#include "cli/tool.h"
#include "find/refinement.h"
#include "find/registration.h"
#include "find/view.h"
#include "job/boundary.h"

#include <chrono>
#include <map>

using namespace fettle;
using Eigen::Index;

namespace {

struct Scored {
    int points = 0;
    double height = 0, width = 0, iou = 0, left_out = 0, probability = 0;
};

std::map<int, Scored> truths(const mesh::CloudMesh& part, const Eigen::VectorXd& truth)
{
    const Eigen::VectorXd heights = cloud::field(part.points, "truth_height");
    const find::HeightMap map = find::height_map(part, find::View::Identity());
    std::map<int, Scored> result;
    std::map<int, find::Mask> masks;
    for (Index i = 0; i < truth.size(); ++i)
        if (truth[i] > 0) {
            Scored& one = result[int(truth[i])];
            ++one.points;
            one.height = std::max(one.height, heights[i]);
            find::Mask& mask = masks.try_emplace(int(truth[i]), map.z.size(), std::uint8_t(0)).first->second;
            mask(map.cell_of(part.points.xyz.col(i).head<2>())) = 255;
        }
    for (auto& [number, one] : result) one.width = find::thickness_of(find::closed(masks.at(number), 1));
    return result;
}

double left_out(const cloud::Cloud& points, const Eigen::VectorXd& truth, int number, const find::FoundAnomaly& found)
{
    int outside = 0, all = 0;
    for (Index i = 0; i < truth.size(); ++i)
        if (int(truth[i]) == number) {
            ++all;
            const Eigen::Vector3d p = found.T_anomaly_part * Eigen::Vector3d(points.xyz.col(i));
            outside += !job::contains(found.boundary, p.head<2>());
        }
    return double(outside) / all;
}

find::FindResult search(const mesh::CloudMesh& part, const std::string& against)
{
    const find::FindOptions options{{}, 0.05};
    if (against.empty()) return find::find_anomalies(part, options);
    const mesh::MeshOrCloud reference = mesh::read_shape(against, {}).shape;
    const find::Registration registration = find::register_part(part, reference, {});
    return find::find_anomalies_against(part, find::signed_distances(part, reference, registration.T_reference_part),
                                        options);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Scores finds by what is known.", [](cli::Tool& t) {
        const std::string& path = t.main_input("PART", "points with truth and truth_height");
        const std::string& against = t.optional_file("--against", "REF", "compare with it");
        t.parse();
        const mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, {});
        const cloud::Cloud& points = file.part.points;
        const Eigen::VectorXd truth = cloud::field(points, "truth");
        const auto start = std::chrono::steady_clock::now();
        const find::FindResult result = search(file.part, against);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        std::map<int, Scored> scored = truths(file.part, truth);
        for (const find::FoundAnomaly& found : result.anomalies) {
            std::map<int, int> common;
            for (const Index i : found.points)
                if (truth[i] > 0) ++common[int(truth[i])];
            double on_anomaly = 0;
            for (const auto& [number, count] : common) {
                on_anomaly = std::max(on_anomaly, double(count) / double(found.points.size()));
                Scored& one = scored[number];
                const double iou = count / (one.points + double(found.points.size()) - count);
                if (iou > one.iou)
                    one.iou = iou, one.left_out = left_out(points, truth, number, found),
                    one.probability = found.probability;
            }
            t.output() << "find," << (on_anomaly > 0.3) << ',' << found.probability << ',' << found.height << ','
                       << found.area << ',' << found.score << ',' << found.doubtful_others << ',' << found.doubt
                       << '\n';
        }
        for (const auto& [number, one] : scored)
            t.output() << "true," << number << ',' << one.points << ',' << one.height / result.noise << ',' << one.width
                       << ',' << one.iou << ',' << one.left_out << ',' << one.probability << '\n';
        t.output() << "run," << result.noise << ',' << seconds << '\n';
        return cli::Verdict::yes;
    });
}
