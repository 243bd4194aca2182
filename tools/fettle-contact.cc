#include "belt/belt_options.h"
#include "belt/belt_report.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/text.h"

using namespace fettle;

namespace {

Eigen::Isometry3d parse_pose(const std::string& text, double mm)
{
    const Eigen::VectorXd n = core::parse_number_list(text, {"x", "y", "z", "qw", "qx", "qy", "qz"});
    const Eigen::Vector4d rotation(n[3], n[4], n[5], n[6]);
    if (!(rotation.norm() > 0)) throw core::InputError("--at", "the quaternion is 0");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = mm * Eigen::Vector3d(n[0], n[1], n[2]);
    pose.linear() =
        Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3]).normalized().toRotationMatrix();
    return pose;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Compute the pressure of an elastic contact wheel on a workpiece, at one contact point.\n"
        "The surfels under the wheel that face it become heights on a regular grid; the wheel's layer, bonded to a "
        "rigid hub, is pressed on them without friction. The pose's x y z is the contact point, its z axis the outward "
        "normal, its x axis along the feed; the wheel's axis is y. Indentation: how far the wheel's lowest point would "
        "lie below the contact point if nothing gave way. Out: a point for each cell with pressure and gap.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& points = t.main_input("SURFELS", "points with normals (fettle-surfel), PCD or PLY");
        const std::string& wheel_file = t.required_file_option("--wheel", "FILE", "The wheel, JSON");
        const std::string& at = t.required_text("--at", "X,Y,Z,QW,QX,QY,QZ", "The pose, in the unit of SURFELS");
        const auto& unit = t.length_unit("--file-units", "Unit of SURFELS, and of lengths here [its header, or mm]");
        const auto& force = t.optional_number("--force", "FORCE", "Press with this force, N", core::Range::positive());
        const auto& depth =
            t.optional_number("--depth", "LENGTH", "Press to this indentation", core::Range::positive());
        const belt::ContactOptions contact(t, 64, 1e-6);
        const cloud::CloudOutput out{t};
        t.example("fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 | "
                  "fettle-contact --wheel wheels/rubber.json --at 1000,1000,500,0.7071,0,0,0.7071 --force 20 --report "
                  "press.json > pressure.pcd",
                  "20 N on the keel's middle");
        t.reference("Ren et al. 2006, 3; Johnson 1985, 5.8; Polonsky & Keer 1999; Hughes 1980");
        t.parse();

        if (force.has_value() == depth.has_value())
            throw core::InputError("--force", "either --force or --depth says how the wheel is pressed on");
        contact.check();
        const belt::SurfelFile part = belt::read_surfels(points, unit);
        const units::Units& units = part.file.units;
        const belt::ContactWheel wheel = belt::read_contact_wheel(wheel_file);
        const Eigen::Isometry3d pose = parse_pose(at, units.mm());
        belt::WheelContactSolver contact_solver(part.surfels, wheel, contact.values());
        const belt::WheelContact& press =
            contact_solver.solve(pose, {force.has_value(), force ? *force : *depth * units.mm()});
        t.report() = belt::to_json(press, out.units(units));
        if (const std::string doubt = belt::edge_warning(press.is_near_edge ? 1 : 0, contact.values()); !doubt.empty())
            t.warn(doubt);
        out.write(belt::to_cloud(press, contact_solver.residual_gap(), pose), units);
        return cli::Verdict::yes;
    });
}
