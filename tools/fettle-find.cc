#include "cli/option.h"
#include "cli/tool.h"
#include "core/file.h"
#include "find/find.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

using namespace fettle;

namespace {

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("PART", "A cloud (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF)");
    const std::optional<units::Units::Length>& unit = t.length_unit("--file-units", "Unit of PART, if it states none");
    const std::string& format =
        t.choice("--format", "", {"pcd", "ply", "csv", "vtk", "stl"},
                 "Format of the output; default: by the suffix of -o, else PCD, or STL for a mesh");
};

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Finds anomalies of a part.", [](cli::Tool& t) {
        const Options o{t};
        t.parse();
        mesh::CloudMeshFile file = mesh::read_cloud_mesh(o.path, mesh::resolve_file_units(o.unit));
        const std::string name = core::display_name(o.path);
        const mesh::PartFormat format = mesh::part_format(t.output_name(), o.format, file.part.is_mesh());
        const find::FindResult result = cli::with_error_prefix(name, [&] { return find::find_anomalies(file.part); });
        t.report().set("noise", result.noise);
        std::vector<json::Value> rows;
        for (std::size_t k = 0; k < result.anomalies.size(); ++k) {
            const auto& a = result.anomalies[k];
            rows.push_back(json::Value().set("anomaly", k + 1).set("probability", a.probability).set("height", a.height)
                .set("area", a.area).set("volume", a.volume).set("significance", a.significance)
                .set("boundary", json::Value(Eigen::MatrixXd(a.boundary.transpose()))));
        }
        t.report().set("anomalies", rows);
        mesh::write_cloud_mesh(t.output(), find::labelled(std::move(file.part), result), format, file.units);
        return result.anomalies.empty() ? cli::Verdict::yes : cli::Verdict::no;
    });
}
