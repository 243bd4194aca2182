// The evidence on every candidate of a part, to learn from:    find-evidence PART.pcd > evidence.csv
//
// PART, seen from +z, has a field `truth`: 0, or the number of the anomaly that a point is on. A row for each verified
// candidate: the largest intersection over union of its cells with those of one anomaly, the share of its cells that
// are on any, its box (x, y, width, height in cells), then the features. -v says for each anomaly how well the best
// candidate and the best verified one cover it.
#include "cli/tool.h"
#include "find/verification.h"
#include "find/view.h"
#include "mesh/shape_file.h"

#include <cstdio>
#include <map>

using namespace fettle;

namespace {

cv::Mat1i truth_map(const cloud::Cloud& points, const find::HeightMap& map)
{
    cv::Mat1i truth(map.z.size(), 0);
    const Eigen::VectorXd field = cloud::field(points, "truth");
    for (Eigen::Index i = 0; i < points.size(); ++i)
        if (points.xyz.col(i).allFinite() && field[i] > 0)
            truth(map.cell_of(points.xyz.col(i).head<2>())) = int(field[i]);
    truth.setTo(0, ~map.seen);
    return truth;
}

struct Overlap {
    int anomaly = 0;
    double iou = 0, share = 0;
};

Overlap overlap_of(const cv::Mat1i& truth, const std::map<int, int>& cells, const cv::Rect& box, const find::Mask& mask)
{
    std::map<int, int> common;
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (const int k = truth(y + box.y, x + box.x); mask(y, x) && k > 0) ++common[k];
    Overlap best;
    const int size = cv::countNonZero(mask);
    for (const auto& [k, count] : common) {
        best.share += double(count) / size;
        if (const double iou = double(count) / (cells.at(k) + size - count); iou > best.iou)
            best.iou = iou, best.anomaly = k;
    }
    return best;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Evidence on every candidate of a part, CSV.", [](cli::Tool& t) {
        const std::string& path = t.main_input("PART", "points with a field truth");
        t.parse();
        const mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, {});
        const find::SearchBounds bounds;
        find::HeightMap map = find::height_map(file.part, find::View::Identity());
        find::clean(map);
        const cv::Mat1i truth = truth_map(file.part.points, map);
        std::map<int, int> cells;
        for (const int k : truth)
            if (k > 0) ++cells[k];
        std::map<int, Overlap> best, best_verified;
        const std::vector<find::Candidate> candidates = find::find_candidates(map, bounds);
        for (const find::Candidate& candidate : candidates) {
            const Overlap o = overlap_of(truth, cells, candidate.box, candidate.mask);
            if (o.iou > best[o.anomaly].iou) best[o.anomaly] = o;
        }
        for (const find::Verified& v : find::verify_all(map, candidates, bounds)) {
            const Overlap o = overlap_of(truth, cells, v.window, v.mask);
            if (o.iou > best_verified[o.anomaly].iou) best_verified[o.anomaly] = o;
            const cv::Rect box = cv::boundingRect(v.mask) + v.window.tl();
            t.output() << o.iou << ',' << o.share << ',' << box.x << ',' << box.y << ',' << box.width << ','
                       << box.height;
            for (const double feature : find::features_of(v.evidence)) t.output() << ',' << feature;
            t.output() << '\n';
        }
        for (const auto& [k, count] : cells)
            t.note(std::to_string(k) + ": " + std::to_string(count) + " cells, candidate " +
                   std::to_string(best[k].iou) + ", verified " + std::to_string(best_verified[k].iou));
        return cli::Verdict::yes;
    });
}
