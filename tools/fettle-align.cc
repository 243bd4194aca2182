#include "align/align_run.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "mesh/part_output.h"

#include <algorithm>

using namespace fettle;

namespace {

align::HeldAxes held_axes(const std::string& text)
{
    const std::vector<std::string> axes = {"x", "y", "z", "rx", "ry", "rz"};
    align::HeldAxes held{};
    for (const std::string& part : cli::split_list(text)) {
        const auto found = std::find(axes.begin(), axes.end(), part);
        if (found == axes.end())
            throw core::InputError("--hold", "expected some of x,y,z,rx,ry,rz with commas between, got '" + text + "'");
        held[found - axes.begin()] = true;
    }
    return held;
}

/// A mesh is written as such where STL or PLY is asked for; else its vertices.
void write_aligned(const align::AlignRun& run, const mesh::PartOutput& out)
{
    mesh::CloudMesh aligned = run.aligned;
    if (out.format != "stl" && out.format != "ply") aligned.triangles.resize(3, 0);
    out.write(aligned, run.units);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Register a scan: find the rigid motion that puts it onto a reference, wherever it lies.\n"
        "Either is a cloud (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF). A coarse search tries turns that cover all "
        "rotations, those that lay principal axes on each other among them, and the poses for which pairs of points "
        "vote; then iterative closest points, point to plane, trimmed and robust, minimises the distances. Without "
        "--overlap or --max-distance at least a third of the scan must lie on the reference. Out: the points of the "
        "scan moved by the matrix that is reported, bit for bit, with all their fields; a mesh where the suffix of -o "
        "is stl or ply, else its vertices. Exit 1 if the steps did not converge on the reference.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& scan_path = t.main_input("SCAN", "What is moved");
        const std::string& reference_path = t.required_file_option("--to", "FILE", "The reference, which stays");
        const auto& scan_unit = t.length_unit("--file-units", "Unit of SCAN, and of transforms and lengths here");
        const auto& reference_unit = t.length_unit("--to-units", "Unit of the reference");
        const std::string& in =
            t.optional_file("--start,--transform-in", "FILE", "Begin with this 4 x 4 matrix, do not search");
        const std::string& out = t.optional_output("--transform-out", "Write the 4 x 4 matrix, 17 digits", {});
        const bool& near = t.flag("--near", "The scan lies nearly right as it is: do not search");
        const std::string& hold =
            t.text("--hold", "", "AXES",
                   "Directions from x,y,z,rx,ry,rz: no shift of the scan's centroid along these, no "
                   "rotation about these; rx,ry: only rotations about z are tried");
        const auto& max_distance = t.optional_number(
            "--max-distance", "LENGTH",
            "Points farther from the reference do not overlap it; more than the length of SCAN is no limit",
            core::Range::positive());
        const auto& overlap = t.optional_number("--overlap", "SHARE",
                                                "Share of the scan that lies on the reference; "
                                                "without either, found from the distances",
                                                core::Range{0, 1, false, true});
        const int& iterations =
            t.count("--iterations", 200, "Max. number; 0: apply --transform-in as it is", 0, 100000);
        const bool& sure = t.flag("--sure", "Exit 1 also if the result is doubtful: see \"doubt\" in the report");
        const mesh::PartOutput written{t, {"pcd", "ply", "csv", "vtk", "stl"}};
        t.example("fettle-part parts/hammer.json | fettle-align --to scans/hammer.stl --max-distance 0.5 "
                  "--transform-out T.txt --report align.json -o aligned.pcd",
                  "put a part with a weld bead onto its scan; the bead does not disturb");
        t.reference("Chen & Medioni 1992 (point to plane); Chetverikov et al. 2005 (trimming); Alexa 2022 (turns); "
                    "Drost et al. 2010 (point pairs)");
        t.parse();

        if (max_distance && overlap)
            throw core::InputError("--overlap", "cannot go with --max-distance: give one of them");
        align::AlignRequest request{scan_path, reference_path, scan_unit, reference_unit, in, !near, max_distance, {}};
        request.icp.held = held_axes(hold);
        request.icp.overlap = overlap;
        request.icp.max_iterations = iterations;
        const align::AlignRun run = align::align_files(request);

        if (!out.empty()) align::write_transform(t.output_file(out), run.transform);
        write_aligned(run, written);
        t.report() = run.report;
        for (const std::string& warning : run.warnings) t.warn(warning);
        return run.converged && (run.sure || !sure) ? cli::Verdict::yes : cli::Verdict::no;
    });
}
