#pragma once

#include "cloud/cloud.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace fettle::job {

enum class SurfaceType { plane, swept, freeform };
std::string to_string(SurfaceType type);
inline const std::vector<std::string> kSurfaceTypes = {"plane", "swept", "freeform"};
/// @param name  one of kSurfaceTypes
SurfaceType parse_surface_type(const std::string& name);

/// The measuring probe.
struct Probe {
    double accuracy = 0.127; ///< 99 % of touch errors are within ± this, mm (0.005 in, a common probe; Wang 2007, 4.4)
    double tip_radius = 0;   ///< mm; 0: a point probe
};

struct GrindingWheel {
    double radius = 25.4;     ///< mm
    double width = 6.35;      ///< along its axis X_w, mm
    double min_radius = 12.7; ///< below it the wheel is worn out, mm; default of a job: half the radius
    /// Volume of stock ground off per volume of wheel (G ratio), of a simulated wheel; none: the job does not say it.
    std::optional<double> grinding_ratio{};
    std::string source{}; ///< where the ratio comes from; may be empty
};

/// Force bounds and spring of the grinding head (Wang 2007, 5.3.1): force = preload + stiffness · deflection.
struct ForceRange {
    double min = 22.24;      ///< F_min, N
    double down = 44.48;     ///< F_down, N; default of a job: midway between min and max
    double max = 66.72;      ///< F_max, N
    double stiffness = 35.0; ///< N/mm
    double preload = 0;      ///< N
};

struct Feed {
    char axis = 'y';         ///< axis of the working frame W along which the passes run
    double rate = 25.4;      ///< mm/s
    double step_over = 5.08; ///< distance between passes, mm; default of a job: 0.8 of the wheel's width
};

/// Default height of travel moves above what is known of the part, mm (2 in).
inline constexpr double kTravelClearance = 50.8;

/// Grinding task for one region of a casting, as specified by the operator ("kind": "job"). Lengths in mm, forces in N,
/// points in the machine frame M; `units` are those of the job's files. The defaults are those of a small head, in any
/// units: 5/10/15 lbf on a spring of 200 lbf/in, a wheel of 1 in radius and 0.25 in width at 1 in/s.
struct Job {
    std::string source = "job"; ///< name of the file, for messages
    units::Units units;
    /// Pose of the job's frame M in the part's, p_part = T_part_job · p_job, mm; nothing: the part's frame is M.
    std::optional<Eigen::Isometry3d> T_part_job;
    double theta = 0; ///< rad, counter-clockwise about +Z from X_m to X_w (the wheel's axis)
    SurfaceType surface = SurfaceType::freeform;
    bool is_safe_height_known = true; ///< false: neither it nor a boundary's z was given; it then is a guess above 0
    double ruling_direction = 0;      ///< direction of the rulings of a swept surface, rad, counter-clockwise from X_w
    Eigen::Matrix3Xd anomaly;         ///< boundary points {b_i} of the anomaly; z is NaN where it was not given
    Eigen::Matrix3Xd sampling;        ///< boundary points {s_i} of the sampling area; may be empty for a plane
    Probe probe;
    double tolerance = 0.5;    ///< allowed deviation of the ground surface from the desired one, ± mm
    double safe_height = 50.8; ///< z of travel moves, mm; default: kTravelClearance above the highest boundary point
    GrindingWheel wheel;
    ForceRange force;
    Feed feed;
    double removal_coefficient = 7.368; ///< removal coefficient: volume per force and time, mm³/(N s)

    /// Frame that files with coordinates in M are labelled with.
    cloud::Frame frame() const { return T_part_job ? cloud::Frame::job : cloud::Frame::part; }
};

/// Reads a job file ("-": stdin). Its polygons have passed boundaries() (job/boundary.h).
/// @throws InputError that names the key's path, or the polygon and the point
Job read_job(const std::string& path);
/// Reads a job from a JSON object (a plan contains its job).
Job parse_job(json::Reader reader);
/// Writes all members in the job's units, rounded to 15 digits, so that reading and writing do not change a job.
json::Value to_json(const Job& job);
/// The job as it would be read from the file that to_json() gives. @throws InputError as read_job()
Job validated(const Job& job, const std::string& source);

/// Rotation from the machine frame M to the working frame W, p_W = R p_M; both have the same origin and z axis.
Eigen::Matrix2d rotation_working_machine(double theta);

} // namespace fettle::job
