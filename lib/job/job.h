#pragma once

#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

enum class SurfaceType { plane, swept, freeform };
std::string to_string(SurfaceType type);

/// The measuring probe.
struct Probe {
    double accuracy = 0.127; ///< 99 % of the touches lie within ±, mm (0.005 in, a common touch probe; Wang 2007, 4.4)
    double tip_radius = 0;   ///< mm; 0: a point
};

struct GrindingWheel {
    double radius = 25.4;     ///< mm
    double width = 6.35;      ///< along its axis X_w, mm
    double min_radius = 12.7; ///< worn out below it, mm; a job that leaves it out: half the radius
};

/// Forces of the head (Wang 2007, 5.3.1): the spring gives preload + stiffness · deflection.
struct ForceRange {
    double min = 22.24;      ///< F_min, N
    double down = 44.48;     ///< F_down, N; a job that leaves it out: midway between min and max
    double max = 66.72;      ///< F_max, N
    double stiffness = 35.0; ///< N/mm
    double preload = 0;      ///< N
};

struct Feed {
    char axis = 'y';         ///< of the working frame W, along which the passes run
    double rate = 25.4;      ///< mm/s
    double step_over = 5.08; ///< between passes, mm; a job that leaves it out: 0.8 of the wheel's width
};

/// What the operator says about one region of a casting ("kind": "job"). Lengths in mm, forces in N, points in the
/// machine frame M; `units` are those of the job's files. The defaults suit a small head, whatever the job's units:
/// 5/10/15 lbf on a spring of 200 lbf/in, a wheel of 1 in radius and 0.25 in width at 1 in/s.
struct Job {
    std::string source = "job"; ///< the file's name, for messages
    Units units;
    double theta = 0; ///< rad, counter-clockwise about +Z from X_m to X_w (the wheel's axis)
    SurfaceType surface = SurfaceType::freeform;
    double direction = 0;      ///< of the rulings of a swept surface, rad, counter-clockwise from X_w
    Eigen::Matrix3Xd anomaly;  ///< boundary points {b_i}; z is NaN where it was left out
    Eigen::Matrix3Xd sampling; ///< boundary points {s_i}; may be empty for a plane
    Probe probe;
    double tolerance = 0.5;    ///< of the ground surface over the desired one, mm
    double safe_height = 50.8; ///< z for travelling, mm; left out: 50.8 above the highest boundary point (or 0)
    GrindingWheel wheel;
    ForceRange force;
    Feed feed;
    double removal = 7.368; ///< volume per force and time, mm³/(N s)
};

/// Reads a job file ("-": stdin). Its polygons have passed boundaries() (job/boundary.h).
/// @throws InputError with the key's path, or the polygon and the place
Job read_job(const std::string& path);
/// Reads the job from an object (a plan carries its job).
Job parse_job(json::Reader reader);
/// All members, in the job's units, rounded so that a job read, written and read again is the same.
json::Value to_json(const Job& job);

/// Working frame: W = R_z(-theta) M; same origin, same z.
Eigen::Matrix2d rotation_working_machine(double theta);

} // namespace fettle
