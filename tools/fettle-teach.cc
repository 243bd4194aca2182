#include "cli/questions.h"
#include "cli/tool.h"
#include "core/constants.h"
#include "core/text.h"
#include "gantry/driver.h"
#include "gantry/make_virtual.h"
#include "job/boundary.h"
#include "job/job.h"
#include "job/picked.h"
#include "removal/height_field.h"
#include "sampling/scan.h"
#include "strategy/teach.h"
#include "json/document.h"
#include "json/units.h"

#include <cmath>
#include <memory>
#include <optional>
#include <ostream>

using namespace fettle;

namespace {

const std::string kDriver = "exec:", kVirtual = "virtual", kDynamic = "virtual:dynamic";
const std::vector<std::string> kSurfaces = {"plane", "swept", "freeform"}, kModes = {"automatic", "manual"};

/// The job as it would be read from a file: with all that read_job() checks.
Job checked(const Job& job) { return parse_job(json::Reader::parse(to_json(job).text(), "the job that was taught")); }

/// What was taught, in numbers by which a point that went astray is noticed.
void report_boundaries(json::Value& out, const Job& job)
{
    const auto [B, S] = boundaries(job);
    const double mm = job.units.mm();
    Eigen::Matrix3Xd points(3, job.anomaly.cols() + job.sampling.cols());
    points << job.anomaly, job.sampling;
    out.set("anomaly_points", static_cast<std::size_t>(job.anomaly.cols()))
        .set("sampling_points", static_cast<std::size_t>(job.sampling.cols()))
        .set("anomaly_area", area(B) / (mm * mm))
        .set("sampling_area", area(S) / (mm * mm))
        .set("lowest", points.row(2).minCoeff<Eigen::PropagateNumbers>() / mm)
        .set("highest", points.row(2).maxCoeff<Eigen::PropagateNumbers>() / mm);
}

void set_surface(Job& job, const std::string& name)
{
    job.surface = name == "plane" ? SurfaceType::plane : name == "swept" ? SurfaceType::swept : SurfaceType::freeform;
}

/// What is moved, and where.
struct GantryOptions {
    const std::string& kind;
    const std::string& machine;
    const std::string& stock;
    const std::optional<Units::Length>& stock_units;
    const std::string& steer;
    const std::optional<double>& lowest;
    const double& patience;
};

void check(const GantryOptions& o)
{
    const bool driver = o.kind.rfind(kDriver, 0) == 0 && o.kind != kDriver;
    if (!driver && o.kind != kVirtual && o.kind != kDynamic)
        throw InputError("--gantry: '" + o.kind + "' is none of virtual, virtual:dynamic, exec:COMMAND");
    if ((o.kind == kDynamic) == o.machine.empty())
        throw InputError("--machine", "goes with --gantry virtual:dynamic, and that with it");
    if (driver != o.stock.empty()) throw InputError("--stock", "goes with a virtual gantry, and that with it");
    if (o.steer.empty()) throw InputError("--steer", "goes with --gantry");
}

/// All of the scan: nobody knows yet where the anomaly is.
HeightField whole(const Scan& scan, const Job& job)
{
    const Eigen::Matrix<double, 3, 2> bounds = scan.bounds();
    Eigen::Matrix<double, 2, 4> corners;
    corners << bounds(0, 0), bounds(0, 1), bounds(0, 1), bounds(0, 0), bounds(1, 0), bounds(1, 0), bounds(1, 1),
        bounds(1, 1);
    corners = (rotation_working_machine(job.theta) * corners).eval();
    Eigen::Matrix2d box;
    box << corners.rowwise().minCoeff(), corners.rowwise().maxCoeff();
    HeightField field = empty_height_field(box, {0, 0}, job.theta, cell_of(job, 0));
    lay(field, scan);
    return field;
}

void teach_on_gantry(Tool& t, const GantryOptions& o, Questions& who, Job& job)
{
    const double mm = job.units.mm();
    Steering steering(o.steer);
    std::unique_ptr<VirtualGantry> simulated;
    std::unique_ptr<DriverGantry> driver;
    if (o.stock.empty())
        driver = std::make_unique<DriverGantry>(o.kind.substr(kDriver.size()), job, o.patience);
    else
        simulated =
            make_virtual(whole(read_scan(o.stock, job.units, o.stock_units), job), job, {o.machine, 1, t.seed()});
    Gantry& gantry = driver ? static_cast<Gantry&>(*driver) : *simulated;
    const protocol::Limits limits = driver ? driver->limits() : simulated->limits();
    int missed = 0;
    const auto recorded = [&](const char* boundary, Eigen::Index number, const Eigen::Vector3d& point) {
        const bool touched = !std::isnan(point.z());
        if (!touched) ++missed;
        if (point.z() >= job.safe_height)
            throw InputError("safe_height " + to_short_text(job.safe_height / mm) + " is not above the touch at z " +
                             to_short_text(point.z() / mm));
        const std::string said = std::string(boundary) + " " + std::to_string(number) + ": " +
                                 place(point.head<2>(), job.units) + ", " +
                                 (touched ? "z " + to_short_text(point.z() / mm) : "no surface");
        who.say(said + "\n");
        t.note(said);
    };
    who.say("Steer; record points around the anomaly, next, points around what may be touched, next.\n");
    const double lowest = o.lowest ? *o.lowest * mm : limits.least.z();
    TaughtBoundaries taught = teach_boundaries(job, gantry, limits, steering, lowest, recorded);
    job.anomaly = std::move(taught.anomaly);
    job.sampling = std::move(taught.sampling);
    if (missed > 0)
        t.warn(std::to_string(missed) + (missed == 1 ? " point" : " points") + " met no surface: recorded without z");
    t.report().set("touches_without_surface", missed).set("machine_time", gantry.status().time);
}

/// What is said about the work; nothing: as it is in the job, or asked for.
struct Settings {
    const std::string& surface;
    const std::optional<double>& direction;
    const std::optional<double>& theta;
};

void set(Job& job, const Settings& said, Questions* who)
{
    if (said.theta)
        job.theta = *said.theta * kRadPerDegree;
    else if (who != nullptr)
        job.theta = who->number("θ of the wheel's axis, degrees", job.theta / kRadPerDegree) * kRadPerDegree;
    if (!said.surface.empty())
        set_surface(job, said.surface);
    else if (who != nullptr)
        set_surface(job, who->choose("Surface", kSurfaces, to_string(job.surface)));
    if (said.direction) {
        if (job.surface != SurfaceType::swept) throw InputError("--direction", "goes with a swept surface alone");
        job.direction = *said.direction * kRadPerDegree;
    } else if (who != nullptr && job.surface == SurfaceType::swept) {
        job.direction =
            who->number("Rulings, degrees from the wheel's axis", job.direction / kRadPerDegree) * kRadPerDegree;
    }
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Make a job from points shown on a gantry, or picked on a scan.", [](Tool& t) {
        const std::string& like = t.file("JOB", "Settings to start from: any job, JSON; its boundaries are replaced");
        const std::string& anomaly =
            t.other_file("--anomaly", "POINTS", "Around the anomaly, picked in CloudCompare or pcd_viewer: their text");
        const std::string& sampling = t.other_file("--sampling", "POINTS", "Around what may be touched");
        const auto& file_units = t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
        const GantryOptions on = {
            t.text("--gantry", "", "virtual|virtual:dynamic|exec:COMMAND",
                   "Or shown on a machine: a simulated gantry, one with drives, or a driver (docs/driver.md). Settings "
                   "that are not given are asked for on stdin"),
            t.other_file("--machine", "FILE", "The machine of virtual:dynamic, JSON"),
            t.other_file("--stock", "PART", "The part beneath a virtual gantry: STL, PLY, OBJ or PCD"),
            t.length_unit("--stock-units", "Unit of PART, if it is not the job's"),
            t.other_file(
                "--steer", "EVENTS",
                "The operator's stick: a joystick's device (button 2: record, 3: next), the keys of /dev/tty, or a "
                "file or pipe of lines "
                "(docs/formats.md); -: stdin, and nothing is asked"),
            t.number_if_given("--lowest", "Z", "The probe goes no lower; default: as far as the machine reaches"),
            t.number("--patience", 10, "SECONDS", "A driver may answer so much later than the move takes",
                     Range::positive())};
        const std::string& surface = t.choice("--surface", "", kSurfaces, "Of the good surface; default: as in JOB");
        const auto& direction = t.number_if_given("--direction", "DEG", "Of the rulings of a swept surface, from X_w");
        const auto& theta = t.number_if_given("--theta", "DEG", "Of the wheel's axis, counter-clockwise from X_m");
        const std::string& mode =
            t.choice("--mode", "", kModes, "With --gantry: how it is to be ground, for the report; default: automatic");
        t.example("fettle-teach jobs/wang1.json --gantry virtual --stock <(fettle-part parts/wang1.json) "
                  "--steer steering/teach.txt",
                  "eight points around the H of Wang's part 1, shown on a simulated gantry");
        t.reference("Wang 2007, 3 and 6.1.1: what the operator teaches");
        t.parse();
        if (on.kind.empty() == anomaly.empty()) throw InputError("--anomaly", "or --gantry must be given, not both");
        if (!on.kind.empty()) check(on);
        if (anomaly.empty() && (!sampling.empty() || file_units))
            throw InputError("--sampling, --file-units: go with --anomaly");

        Job job = read_job(like);
        t.report().set("kind", "teach").set("units", json::to_json(job.units.length));
        const Settings said = {surface, direction, theta};
        if (on.kind.empty()) {
            const double mm = mm_per(file_units.value_or(job.units.length));
            job.anomaly = read_picked(anomaly) * mm;
            const bool was_plane = job.surface == SurfaceType::plane;
            set(job, said, nullptr);
            if (!sampling.empty())
                job.sampling = read_picked(sampling) * mm;
            else if (was_plane && job.surface == SurfaceType::plane)
                job.sampling.resize(3, 0); // a plane may do without; the old one lies elsewhere
            const Job taught = checked(job);
            report_boundaries(t.report(), taught);
            t.output() << to_json(taught);
            return Verdict::yes;
        }
        Questions who(on.steer != "-");
        set(job, said, &who); // first: the head turns to θ before anything is touched
        t.report().set("mode", mode.empty() ? who.choose("Mode", kModes, kModes[0]) : mode);
        teach_on_gantry(t, on, who, job);
        const Job taught = checked(job);
        report_boundaries(t.report(), taught);
        if (who.choose("Write the job", {"start", "stop"}, "start") == "stop")
            throw InputError("stopped by the operator: no job is made");
        t.output() << to_json(taught);
        return Verdict::yes;
    });
}
