#include "belt/press.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "machining/number_list.h"

using namespace fettle;

namespace {

Eigen::Isometry3d pose_of(const std::string& text, double mm)
{
    const std::vector<double> n = numbers_of(text, {"x", "y", "z", "qw", "qx", "qy", "qz"});
    const Eigen::Vector4d turn(n[3], n[4], n[5], n[6]);
    if (!(turn.norm() > 0)) throw InputError("--at", "the quaternion is 0");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = mm * Eigen::Vector3d(n[0], n[1], n[2]);
    pose.linear() = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).normalized().toRotationMatrix();
    return pose;
}

void report(json::Value& out, const Press& press, const Units& units)
{
    const double mm = units.mm(), newton = units.newton();
    const Contact& contact = press.contact;
    out.set("force", contact.force / newton)
        .set("peak_pressure", contact.pressure.maxCoeff() * mm * mm / newton)
        .set("indentation", contact.indentation / mm)
        .set("area", press.area() / (mm * mm))
        .set("cell", Eigen::VectorXd(press.cells.cell / mm))
        .set("iterations", contact.iterations)
        .set("near_edge", press.is_near_edge);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "The pressure of an elastic contact wheel on a workpiece, at one contact point.\n"
        "The surfels under the wheel that face it become heights on a regular grid; the wheel's layer, bonded to a "
        "rigid hub, is pressed on them without friction. The pose's x y z is the contact point, its z axis the outward "
        "normal, its x axis along the feed; the wheel's axis is y. Indentation: how far the wheel's lowest point would "
        "lie below the contact point if nothing gave way. Out: a point for each cell with pressure and gap.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& points = t.input("SURFELS", "points with normals (fettle-surfel), PCD or PLY");
        const std::string& wheel_file = t.required_file("--wheel", "FILE", "The wheel, JSON");
        const std::string& at = t.required_text("--at", "X,Y,Z,QW,QX,QY,QZ", "The pose, in the unit of SURFELS");
        const auto& unit = t.length_unit("--file-units", "Unit of SURFELS, and of lengths here [its header, or mm]");
        const auto& force = t.number_if_given("--force", "FORCE", "Press with this force, N", Range::positive());
        const auto& depth = t.number_if_given("--depth", "LENGTH", "Press to this indentation", Range::positive());
        const std::string& solver = t.choice(
            "--solver", "layer", {"layer", "fem"},
            "Compliance of the bonded layer in Fourier space, flat and without edges; or linear finite elements "
            "of the round layer with its free sides");
        const int& elements = t.count("--elements", 8, "From the surface to the hub, of --solver fem", 1, 64);
        const std::string& gridding =
            t.choice("--gridding", "kriging", {"kriging", "shepard"}, "How heights between surfels are estimated");
        const int& cells = t.count("--cells", 64, "Along each side of the grid; of --solver fem 256 at most", 8, 512);
        const double& tolerance = t.number("--tolerance", 1e-6, "SHARE",
                                           "Of peak pressure times indentation: most pressure times gap", {1e-9, 1e-2});
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 | "
                  "fettle-contact --wheel wheels/rubber.json --at 1000,1000,500,0.7071,0,0,0.7071 --force 20 --report "
                  "press.json > pressure.pcd",
                  "20 N on the keel's middle");
        t.reference("Ren et al. 2006, 3; Johnson 1985, 5.8; Polonsky & Keer 1999; Hughes 1980");
        t.parse();

        if (force.has_value() == depth.has_value())
            throw InputError("--force", "either --force or --depth says how the wheel is pressed on");
        constexpr int kMostElements = 256; // along a side: memory grows with the cube, 140 MB here
        if (solver == "fem" && cells > kMostElements)
            throw InputError("--cells", "at most " + std::to_string(kMostElements) + " with --solver fem");
        const CloudFile file = read_cloud(points, unit ? std::optional(Units{*unit, Units::Force::N}) : std::nullopt);
        const Surfels surfels = surfels_of(file.cloud, display_name(points));
        const ContactWheel wheel = read_contact_wheel(wheel_file);
        const Eigen::Isometry3d pose = pose_of(at, file.units.mm());
        PressOptions options;
        options.gridding = gridding == "shepard" ? Gridding::shepard : Gridding::kriging;
        options.cells = cells;
        options.solver = solver == "fem" ? LayerSolver::fem : LayerSolver::layer;
        options.elements = elements;
        options.tolerance = tolerance;
        WheelPress wheel_press(surfels, wheel, options);
        const Press& press = wheel_press.at(pose, {force.has_value(), force ? *force : *depth * file.units.mm()});
        report(t.report(), press, file.units);
        if (press.is_near_edge && options.solver == LayerSolver::layer)
            t.warn("the contact is nearer to the wheel's edge than 1.5 thicknesses of its layer, where it is softer "
                   "than reckoned; --solver fem sees the edge");
        write_pcd(t.output(), to_cloud(press, wheel_press.gap_left(), pose), file.units,
                  ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return Verdict::yes;
    });
}
