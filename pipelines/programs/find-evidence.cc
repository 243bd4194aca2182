// The evidence on every candidate of a part, to learn from:    find-evidence PART.pcd > evidence.csv
//
// PART, seen from +z, has the fields `truth` (0, or the number of the anomaly that a point is on) and `truth_height`.
// A line for each verified candidate: "candidate", the anomaly that its cells cover best, their intersection over
// union, the share of its cells that are on any, its box (x, y, width, height in cells), then the features; a line for
// each anomaly: "truth", number, height in noise, width in cells (the largest inscribed circle's diameter),
// intersection over union of the best candidate before and after verification.
#include "cli/tool.h"
#include "find/refinement.h"
#include "find/view.h"
#include "mesh/shape_file.h"

#include <map>

using namespace fettle;

namespace {

struct Truth {
    cv::Mat1i number;              ///< of the anomaly at each cell
    std::map<int, int> cells;      ///< of each
    std::map<int, double> heights; ///< mm
};

Truth truth_of(const cloud::Cloud& points, const find::HeightMap& map)
{
    Truth truth{cv::Mat1i(map.z.size(), 0), {}, {}};
    const Eigen::VectorXd numbers = cloud::field(points, "truth"), heights = cloud::field(points, "truth_height");
    for (Eigen::Index i = 0; i < points.size(); ++i) {
        const int k = int(numbers[i]);
        if (!points.xyz.col(i).allFinite() || k == 0) continue;
        truth.number(map.cell_of(points.xyz.col(i).head<2>())) = k;
        truth.heights[k] = std::max(truth.heights[k], heights[i]);
    }
    truth.number.setTo(0, ~map.seen);
    for (const int k : truth.number)
        if (k > 0) ++truth.cells[k];
    return truth;
}

struct Overlap {
    int anomaly = 0;
    double iou = 0, share = 0;
};

Overlap overlap_of(const Truth& truth, const cv::Rect& box, const find::Mask& mask)
{
    std::map<int, int> common;
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (const int k = truth.number(y + box.y, x + box.x); mask(y, x) && k > 0) ++common[k];
    Overlap best;
    const int size = cv::countNonZero(mask);
    for (const auto& [k, count] : common) {
        best.share += double(count) / size;
        if (const double iou = double(count) / (truth.cells.at(k) + size - count); iou > best.iou)
            best.iou = iou, best.anomaly = k;
    }
    return best;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Evidence on every candidate of a part, CSV.", [](cli::Tool& t) {
        const std::string& path = t.main_input("PART", "points with the fields truth and truth_height");
        t.parse();
        const mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, {});
        const find::SearchBounds bounds;
        find::HeightMap map = find::height_map(file.part, find::View::Identity());
        find::clean(map, true); // its cases are clouds
        const Truth truth = truth_of(file.part.points, map);
        std::map<int, double> best, best_verified;
        const std::vector<find::Candidate> candidates = find::find_candidates(map, bounds);
        for (const find::Candidate& candidate : candidates) {
            const Overlap o = overlap_of(truth, candidate.box, candidate.mask);
            best[o.anomaly] = std::max(best[o.anomaly], o.iou);
        }
        for (const find::Verified& v : find::verify_all(map, candidates, bounds)) {
            const Overlap o = overlap_of(truth, v.window, v.mask);
            best_verified[o.anomaly] = std::max(best_verified[o.anomaly], o.iou);
            const cv::Rect box = cv::boundingRect(v.mask) + v.window.tl();
            t.output() << "candidate," << o.anomaly << ',' << o.iou << ',' << o.share << ',' << box.x << ',' << box.y
                       << ',' << box.width << ',' << box.height;
            for (const double feature : find::features_of(v.evidence)) t.output() << ',' << feature;
            t.output() << '\n';
        }
        for (const auto& [k, count] : truth.cells)
            t.output() << "truth," << k << ',' << truth.heights.at(k) / map.sigma << ','
                       << find::thickness_of(find::closed(truth.number == k, 1)) << ',' << best[k] << ','
                       << best_verified[k] << '\n';
        return cli::Verdict::yes;
    });
}
