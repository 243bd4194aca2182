#include "align/align.h"
#include "cli/option.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/test_points.h"
#include "core/file.h"

#include <algorithm>

namespace {

using namespace fettle;

HeldAxes held_axes(const std::string& text)
{
    const std::vector<std::string> axes = {"x", "y", "z", "rx", "ry", "rz"};
    HeldAxes held{};
    for (const std::string& part : listed(text)) {
        const auto found = std::find(axes.begin(), axes.end(), part);
        if (found == axes.end())
            throw InputError("--hold", "expected some of x,y,z,rx,ry,rz with commas between, got '" + text + "'");
        held[static_cast<std::size_t>(found - axes.begin())] = true;
    }
    return held;
}

Eigen::Isometry3d start_of(const Eigen::Matrix4d& matrix, double mm)
{
    Eigen::Isometry3d start(matrix);
    start.translation() *= mm;
    return start;
}

Eigen::Matrix4d matrix_of(const Eigen::Isometry3d& motion, double mm)
{
    Eigen::Matrix4d matrix = motion.matrix();
    matrix.topRightCorner<3, 1>() /= mm;
    return matrix;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Registers a scan: finds the rigid motion that puts it onto a reference, wherever it lies.\n"
        "Either is a cloud (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF). A coarse search tries turns that cover all "
        "rotations, those that lay principal axes on each other among them; then iterative closest points, point to "
        "plane, trimmed and robust, descends to the least distances. At least a third of the scan must lie on the "
        "reference. Out: the points of the scan (vertices, if it is a mesh) moved by the matrix that is reported, bit "
        "for bit, with all their fields. Exit 1 if the steps did not converge.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& scan_path = t.input("SCAN", "What is moved");
        const std::string& reference_path = t.required_file("--to", "FILE", "The reference, which stays");
        const auto& scan_unit = t.length_unit("--file-units", "Unit of SCAN, and of transforms and lengths here");
        const auto& reference_unit = t.length_unit("--to-units", "Unit of the reference");
        const std::string& in = t.other_file("--transform-in", "FILE", "Begin with this 4 x 4 matrix, do not search");
        const std::string& out = t.other_output("--transform-out", "Write the 4 x 4 matrix, 17 digits");
        const bool& near = t.flag("--near", "The scan lies nearly right as it is: do not search");
        const std::string& hold = t.text("--hold", "", "AXES",
                                         "Of x,y,z,rx,ry,rz: no shift of the scan's centroid along these, no turn "
                                         "about these; rx,ry: only turns about z are tried");
        const auto& max_distance = t.number_if_given(
            "--max-distance", "LENGTH", "Points farther from the reference do not overlap it", Range::positive());
        const auto& overlap = t.number_if_given("--overlap", "SHARE",
                                                "Of the scan that lies on the reference; without "
                                                "either, found from the distances",
                                                Range{0, 1, false, true});
        const int& iterations = t.count("--iterations", 200, "At most; 0: apply --transform-in as it is", 0, 100000);
        const bool& ascii = t.flag("--ascii", "Write text instead of binary");
        t.example("fettle-part parts/hammer.json | fettle-align --to scans/hammer.stl --max-distance 0.5 "
                  "--transform-out T.txt --report align.json -o aligned.pcd",
                  "put a part with a weld bead onto its scan; the bead does not disturb");
        t.reference("Chen & Medioni 1992 (point to plane); Chetverikov et al. 2005 (trimming); Alexa 2022 (turns)");
        t.parse();

        if (max_distance && overlap) throw InputError("--overlap", "goes not with --max-distance: give one of them");
        const ShapeFile scan = read_shape(scan_path, units_of(scan_unit));
        const ShapeFile target = read_shape(reference_path, units_of(reference_unit));
        const double mm = scan.units.mm();
        AlignOptions options;
        options.icp.held = held_axes(hold);
        options.icp.overlap = overlap;
        options.icp.iterations = iterations;
        if (max_distance) options.icp.max_distance = *max_distance * mm;
        Eigen::Matrix4d matrix = in.empty() ? Eigen::Matrix4d::Identity() : read_transform(in);
        if (!in.empty() || near || iterations == 0) options.start = start_of(matrix, mm);

        const auto reference = named(display_name(reference_path), [&] {
            return std::visit([](const auto& shape) { return std::make_unique<AlignReference>(shape); }, target.shape);
        });
        const OrientedPoints points = std::visit([](const auto& shape) { return oriented_points(shape); }, scan.shape);
        const Alignment alignment = named(display_name(scan_path), [&] { return align(points, *reference, options); });
        if (iterations > 0) matrix = matrix_of(alignment.fit.T_reference_scan, mm);

        json::Value& report = t.report();
        Cloud spread;
        spread.xyz = points.xyz;
        report = to_json(alignment, matrix, moved(spread, matrix, mm).xyz, *reference, scan.units);
        if (!out.empty()) write_transform(t.output_file(out), matrix);
        const TestPoints all = test_points(scan.shape, scan.units);
        const Cloud whole = all.part(0, all.points.points);
        if (const auto* cloud = std::get_if<Cloud>(&scan.shape))
            report.set("dropped", static_cast<std::size_t>(cloud->size() - points.xyz.cols()));
        write_pcd(t.output(), moved(whole, matrix, mm), scan.units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);

        if (ambiguous(alignment))
            t.warn(display_name(scan_path) + ": another place fits nearly as well: see \"next\" in the report");
        for (const Freedom& freedom : alignment.freedoms)
            if (!freedom.determined && !freedom.held) {
                t.warn(display_name(scan_path) + ": not all of its motions are determined: see \"degrees_of_freedom\"");
                break;
            }
        return alignment.fit.converged || iterations == 0 ? Verdict::yes : Verdict::no;
    });
}
