// Two jobs for each anomaly that fettle-find finds on a part: its own, and that of an operator who sees the truth:
//
//     find-jobs WORN.pcd --template JOB --folder FOLDER
//
// WORN, seen from +z, has the fields `truth` (0, or the number of the anomaly that a point is on) and `truth_height`.
// The operator's B and S are drawn around the points of the anomaly as the find's around what was found. Out:
// FOLDER/K-found.json, FOLDER/K-operator.json for each anomaly K of which a find covers more than 0.3 (intersection
// over union) and that can have a job, FOLDER/bare.pcd, the part without its anomalies. The tolerance is twice the
// noise, the probe as good as it.
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/error.h"
#include "find/description.h"
#include "find/jobs.h"
#include "find/refinement.h"
#include "mesh/shape_file.h"

#include <map>

using namespace fettle;
using Eigen::Index;

namespace {

constexpr double kMinOverlap = 0.3;                     // intersection over union: as find-score judges
constexpr double kMinTolerance = 0.1, kMinProbe = 0.05; // mm

/// The anomalies of the truth as if they had been verified, all of them in one side.
std::map<int, find::Verified> truths(const find::SeenSide& side, const mesh::CloudMesh& part)
{
    const Eigen::VectorXd number = cloud::field(part.points, "truth"),
                          height = cloud::field(part.points, "truth_height");
    std::map<int, find::Verified> result;
    for (Index i = 0; i < number.size(); ++i) {
        const cv::Point cell = side.surface.cell_of(part.points.xyz.col(i).head<2>());
        if (number[i] == 0 || !cv::Rect({0, 0}, side.surface.z.size()).contains(cell) || !side.surface.seen(cell))
            continue;
        const auto [at, is_new] = result.try_emplace(int(number[i]));
        find::Verified& one = at->second;
        if (is_new) {
            one.window = cv::Rect({0, 0}, side.surface.z.size());
            one.mask = find::Mask(side.surface.z.size(), std::uint8_t(0));
            one.height = find::Image(side.surface.z.size(), 0.F);
        }
        one.mask(cell) = 255;
        one.height(cell) = std::max(one.height(cell), float(height[i]));
        one.evidence.height = std::max(one.evidence.height, height[i]);
    }
    for (auto& [k, one] : result) {
        one.with_rim = one.mask;
        one.evidence.cells = cv::countNonZero(one.mask);
        one.evidence.thickness = find::thickness_of(one.mask);
    }
    return result;
}

/// What an operator would state about an anomaly.
find::FoundAnomaly operators(const find::SeenSide& side, const mesh::CloudMesh& part, const find::CellPoints& cells,
                             const std::map<int, find::Verified>& all, int number)
{
    find::FoundAnomaly anomaly = find::describe(part, side, cells, all.at(number));
    find::Mask others(side.surface.z.size(), std::uint8_t(0));
    for (const auto& [k, other] : all)
        if (k != number) others |= other.mask;
    find::set_outlines(anomaly, side, all.at(number), others);
    return anomaly;
}

/// The find that covers an anomaly best.
const find::FoundAnomaly* best_find(const find::FindResult& result, const Eigen::VectorXd& truth, int number)
{
    const auto size = double((truth.array() == number).count());
    const find::FoundAnomaly* best = nullptr;
    double best_overlap = kMinOverlap;
    for (const find::FoundAnomaly& found : result.anomalies) {
        double common = 0;
        for (const Index i : found.points) common += truth[i] == number;
        const double overlap = common / (size + double(found.points.size()) - common);
        if (overlap > best_overlap) best = &found, best_overlap = overlap;
    }
    return best;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Jobs of what is found, and an operator's.", [](cli::Tool& t) {
        const std::string& path = t.main_input("WORN", "points with truth and truth_height");
        const std::string& settings = t.required_file_option("--template", "JOB", "the machine's values");
        const std::string& folder = t.text("--folder", ".", "FOLDER", "of the jobs");
        t.parse();
        const mesh::CloudMesh part = mesh::read_cloud_mesh(path, {}).part;
        const Eigen::VectorXd truth = cloud::field(part.points, "truth");
        find::SeenSide side{find::View::Identity(), find::height_map(part, find::View::Identity()), {}, false, {}};
        find::clean(side.surface, true);
        const find::CellPoints cells = find::points_by_cell(part, side);
        const std::map<int, find::Verified> all = truths(side, part);
        const find::FindResult result = find::find_anomalies(part);
        job::Job machine = job::read_job(settings);
        machine.tolerance = std::max(kMinTolerance, 2 * result.noise);
        machine.probe.accuracy = std::max(kMinProbe, result.noise);
        for (const auto& [number, one] : all) {
            const find::FoundAnomaly* found = best_find(result, truth, number);
            if (found == nullptr) continue;
            const std::string name = folder + "/" + std::to_string(number);
            const auto write = [&](const find::FoundAnomaly& anomaly, const std::string& whose) {
                try {
                    const job::Job job = find::job_for(anomaly, part, machine).job;
                    t.output_file(name + whose) << job::to_json(job);
                } catch (const core::InputError& error) {
                    t.warn(name + whose + ": " + error.what());
                }
            };
            write(*found, "-found.json");
            write(operators(side, part, cells, all, number), "-operator.json");
        }
        cloud::Cloud bare;
        bare.xyz = part.points.xyz;
        bare.xyz.row(2) -= cloud::field(part.points, "truth_height").transpose();
        cloud::write_pcd(t.output_file(folder + "/bare.pcd"), bare, {});
        return cli::Verdict::yes;
    });
}
