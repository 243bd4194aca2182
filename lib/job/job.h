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
    double min_radius = 12.7; ///< worn out below it, mm
};

/// Forces of the head (Wang 2007, 5.3.1): the spring gives preload + stiffness · deflection.
struct ForceRange {
    double min = 22.24;      ///< F_min, N
    double down = 44.48;     ///< F_down, N
    double max = 66.72;      ///< F_max, N
    double stiffness = 35.0; ///< N/mm
    double preload = 0;      ///< N
};

struct Feed {
    char axis = 'y';         ///< of the working frame W, along which the passes run
    double rate = 25.4;      ///< mm/s
    double step_over = 5.08; ///< between passes, mm
};

/// What the operator says about one region of a casting (INTERFACES: "kind": "job"). Lengths in mm, forces in N,
/// points in the machine frame M; `units` are those of the job's files.
struct Job {
    Units units;
    double theta = 0; ///< rad, counter-clockwise about +Z from X_m to X_w (the wheel's axis)
    SurfaceType surface = SurfaceType::freeform;
    double direction = 0;      ///< of the rulings of a swept surface, rad, counter-clockwise from X_w
    Eigen::Matrix3Xd anomaly;  ///< boundary points {b_i}; z is NaN where it was left out
    Eigen::Matrix3Xd sampling; ///< boundary points {s_i}; may be empty for a plane
    Probe probe;
    double tolerance = 0.5;    ///< of the ground surface over the desired one, mm
    double safe_height = 50.8; ///< z for travelling, mm
    GrindingWheel wheel;
    ForceRange force;
    Feed feed;
    double removal = 7.3673; ///< volume per force and time, mm³/(N s)
};

/// Reads a job file ("-": stdin). @throws InputError with the key's path
Job read_job(const std::string& path);
/// Reads the job from an object (a plan carries its job).
Job parse_job(json::Reader reader);
json::Value to_json(const Job& job);

/// Working frame: W = R_z(-theta) M; same origin, same z.
Eigen::Matrix2d rotation_working_machine(double theta);

} // namespace fettle
