#pragma once

// Cells of the factorial experiment as factorial.cc writes them, read back by the programs that evaluate them.

#include "margin/regression.h"
#include "json/document.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace factorial {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A kind of surface, and Wang's own method for it.
struct Kind {
    fettle::margin::RegressionKind regression;
    std::string method;
};

inline const std::map<std::string, Kind>& kinds()
{
    static const std::map<std::string, Kind> all = {
        {"cylinder", {fettle::margin::RegressionKind::swept, "swept"}},
        {"sphere-convex", {fettle::margin::RegressionKind::convex, "griddata"}},
        {"sphere-concave", {fettle::margin::RegressionKind::concave, "griddata"}},
        {"saddle", {fettle::margin::RegressionKind::saddle, "griddata"}},
    };
    return all;
}

enum Quantity { band, shift, covered };

/// Lengths in inches.
struct Cell {
    int number = 0;
    double radius = 0, width = 0, length = 0, distance = 0;
    int touches = 0;
    Eigen::VectorXd terms;                         ///< of Wang's regressions
    double limit = 0;                              ///< band of the least squares fit of the true family
    std::map<std::string, Eigen::Vector3d> errors; ///< band, shift, covered share of the anomaly, by method

    /// NaN where the method has no surface at all.
    double error(const std::string& method, Quantity quantity) const
    {
        const auto found = errors.find(method);
        return found == errors.end() ? kNaN : found->second[quantity];
    }
    double published(const Kind& kind, Quantity quantity) const
    {
        const fettle::margin::Regression& regression = fettle::margin::published_regression(kind.regression);
        return (quantity == band ? regression.band : regression.shift).dot(terms);
    }
    double area() const { return width * length; }
    double slimness() const { return std::max(width, length) / std::min(width, length); }
};
using Cells = std::vector<Cell>;

struct Study {
    std::vector<std::string> methods;
    std::map<std::string, Cells> surfaces;
};

inline Cell read_cell(fettle::json::Reader& row, const std::vector<std::string>& methods)
{
    const fettle::core::Range positive = fettle::core::Range::positive();
    Cell cell;
    cell.number = row.integer("cell", 0, std::numeric_limits<int>::max());
    cell.radius = row.number("radius", positive);
    cell.width = row.number("width", positive);
    cell.length = row.number("length", positive);
    cell.distance = row.number("distance", positive);
    cell.touches = row.integer("touches", 1, std::numeric_limits<int>::max());
    cell.terms = row.vector("terms");
    cell.limit = row.number("limit", positive);
    fettle::json::Reader errors = row.object("errors");
    for (const std::string& method : methods)
        if (errors.has(method)) cell.errors[method] = errors.vector(method, 3);
    errors.reject_unknown_keys();
    return cell;
}

/// @param path  batches merged into one document
/// @throws InputError for anything else
inline Study read_study(const std::string& path)
{
    fettle::json::Reader reader = fettle::json::Reader::open(path);
    reader.expect_kind("factorial");
    fettle::json::Reader units = reader.object("units");
    units.choice("length", {"in"});
    units.reject_unknown_keys();
    Study study;
    std::istringstream methods(reader.text("methods"));
    for (std::string method; methods >> method;) study.methods.push_back(method);
    std::vector<std::string> names;
    for (const auto& [name, kind] : kinds()) names.push_back(name);
    for (fettle::json::Reader& row : reader.objects("cells")) {
        const std::string surface = row.choice("surface", names);
        study.surfaces[surface].push_back(read_cell(row, study.methods));
        row.reject_unknown_keys();
    }
    reader.reject_unknown_keys();
    return study;
}

/// Quantile of the values that are not NaN; NaN if there are none.
inline double quantile(std::vector<double> values, double share)
{
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.empty()) return kNaN;
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}
inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

/// One number a cell.
template <typename Number>
std::vector<double> each(const Cells& cells, const Number& number)
{
    std::vector<double> values;
    for (const Cell& cell : cells) values.push_back(number(cell));
    return values;
}

} // namespace factorial
