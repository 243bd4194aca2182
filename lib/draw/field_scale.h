#pragma once

#include "cloud/cloud.h"
#include "draw/colours.h"
#include "job/job.h"
#include "units/units.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::draw {

/// A class of points: a value of an integer field with its name, colour, and number of points.
struct FieldClass {
    double value = 0;
    std::string name;
    Rgb colour{};
    Eigen::Index count = 0;
};

/// Colour map of a field's values: the diverging ColourScale, a sequential one, or a colour for each class.
struct PictureScale {
    double low = 0, high = 1;
    bool diverging = false;
    int bands = 0;
    Palette palette = Palette::accessible;
    std::vector<FieldClass> classes; ///< not empty: other values are undefined
    bool packed = false;             ///< values are colours themselves, 0xRRGGBB

    Rgb operator()(double value) const; ///< NaN: kUndefinedColour
};

/// How a scale is chosen.
struct ScaleOptions {
    std::optional<double>
        scale; ///< colours from -scale to +scale (error), else from the minimum to the minimum + scale
    std::optional<std::pair<double, double>> range; ///< lowest and highest value of the scale, instead
    int bands = 0;                                  ///< number of equal colour steps; 0: continuous
    Palette palette = Palette::accessible;
};

/// Scale for a field. `error` has the diverging colours, every other field a sequential map.
/// @param values  NaN: undefined
PictureScale scale_for(const std::string& field, const Eigen::VectorXd& values, const ScaleOptions& options);

/// Ticks of a legend: values from low to high with their text.
std::vector<std::pair<double, std::string>> scale_ticks(const PictureScale& scale);

/// Scale of the field `class` of surfels (Ren et al. 2006, fig. 8: gouge, within, undercut) or of triangle patches,
/// which have a field `d` too (Guan et al., fig. 6: serious and slight over-cut, neutral, slight and serious
/// under-cut). Values that are no class get their number for a name.
/// @param chosen  whose points are counted
PictureScale class_scale(const cloud::Cloud& cloud, const Eigen::VectorXd& chosen, Palette palette);

/// The unit of z or a field by its name: "mm", "N/mm2", …; empty: a plain number.
std::string unit_of_field(const std::string& field, const units::Units& units);

/// The numbers at points inside B, or all of them without a job. @param points  3xN, M
Eigen::VectorXd numbers_inside(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& numbers,
                               const std::optional<job::Job>& job);

/// Values of z or a field in `units`.
/// @throws InputError if the cloud has no such field
Eigen::VectorXd values_of(const cloud::Cloud& cloud, const std::string& field, const units::Units& units);

/// The field rgb as numbers 0xRRGGBB. @throws InputError if there is none
Eigen::VectorXd packed_colours(const cloud::Cloud& cloud);
Rgb unpacked(double colour);

/// Scale and values of z, a field, the classes of the field `class`, or the colours of the field `rgb`.
struct FieldValues {
    Eigen::VectorXd numbers; ///< in the units of the options; one of each point
    PictureScale scale;      ///< chosen for the points inside B, or for all without a job
};
/// @throws InputError if the cloud has no such field
FieldValues field_values(const cloud::Cloud& cloud, const std::string& field, const units::Units& units,
                         const std::optional<job::Job>& job, const ScaleOptions& options);

} // namespace fettle::draw
