#include "core/constants.h"
#include "core/text.h"
#include "surface/shape_json.h"
#include "surface/surface.h"
#include "json/units.h"

#include <cmath>
#include <limits>

namespace fettle::surface {

namespace {

constexpr int kMaxRole = 5;
constexpr double kMaxTouches = 1e9;

using json::Reader;
using json::Value;

// --- covariance: lower triangle, row by row; C_ij has the dimension of θ_i θ_j ---

Eigen::VectorXd parameter_units(const Shape& shape, double mm)
{
    return parameter_powers(shape).unaryExpr([mm](int power) { return std::pow(mm, power); }).cast<double>();
}

Value write_covariance(const Eigen::MatrixXd& covariance, const Shape& shape, double mm)
{
    const Eigen::VectorXd unit = parameter_units(shape, mm);
    const Eigen::Index n = unit.size();
    Eigen::VectorXd packed(n * (n + 1) / 2);
    for (Eigen::Index i = 0, k = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) packed[k++] = covariance(i, j) / (unit[i] * unit[j]);
    return packed;
}

Eigen::MatrixXd read_covariance(Reader& reader, const Shape& shape, double mm)
{
    if (!reader.has("covariance")) return {};
    const Eigen::VectorXd unit = parameter_units(shape, mm);
    const Eigen::Index n = unit.size();
    const Eigen::VectorXd packed = reader.vector("covariance", n * (n + 1) / 2);
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0, k = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j, ++k) covariance(i, j) = covariance(j, i) = packed[k] * unit[i] * unit[j];
    if (covariance.diagonal().minCoeff() < 0) reader.refuse("covariance", "has a negative variance");
    return covariance;
}

// --- alternatives ---

Value write_alternatives(const Surface& surface, double mm)
{
    std::vector<Value> list;
    for (const Alternative& other : surface.alternatives) {
        Value value;
        value.set("method", other.method).set("score", other.score).set("weight", other.weight);
        if (other.weight > 0)
            value.set("shape", shape_to_json(other.shape, mm))
                .set("covariance", write_covariance(other.covariance, other.shape, mm));
        list.push_back(value);
    }
    return list;
}

void read_alternatives(Reader& reader, Surface& surface, double mm)
{
    double sum = surface.weight;
    for (Reader& one : reader.objects("alternatives")) {
        Alternative other;
        other.method = one.text("method");
        other.score = one.number("score");
        other.weight = one.number("weight", core::Range::between(0, 1));
        if (other.weight > 0) {
            other.shape = parse_shape(one.object("shape"), mm);
            other.covariance = read_covariance(one, other.shape, mm);
            if (other.covariance.size() == 0) one.refuse("covariance", "is missing");
        }
        one.reject_unknown_keys();
        sum += other.weight;
        surface.alternatives.push_back(std::move(other));
    }
    constexpr double kSumTolerance = 1e-9; // numbers are written with all digits
    if (std::abs(sum - 1) > kSumTolerance)
        reader.refuse("alternatives", "weights do not sum up to 1 with that of the fit");
}

// --- precision: weights are rounded to four digits, which changes a sigma by 1e-4 of it ---

Value write_precision(const SplinePrecision& precision, double mm)
{
    const auto rounded = [](double value) {
        if (value == 0) return 0.0;
        const double unit = std::pow(10, std::floor(std::log10(value)) - 3);
        return unit < 1 ? std::round(value / unit) / std::round(1 / unit) : std::round(value / unit) * unit;
    };
    Value value;
    return value.set("amplitude", precision.amplitude * mm)
        .set("weights", Value(Eigen::MatrixXd((precision.weights * (mm * mm)).unaryExpr(rounded))));
}

std::optional<SplinePrecision> read_precision(Reader& reader, const Surface& surface, double mm)
{
    std::optional<Reader> object = reader.optional_object("precision");
    if (!object) return std::nullopt;
    const Bspline* spline = std::get_if<Bspline>(&surface.shape);
    if (spline == nullptr) object->refuse("", "belongs to a shape of type bspline");
    if (surface.covariance.size() > 0) object->refuse("", "and covariance are both given: only one is allowed");
    SplinePrecision precision;
    precision.amplitude = object->number("amplitude", core::Range::positive()) / mm;
    precision.weights = object->matrix("weights") / (mm * mm);
    if (precision.weights.rows() != spline->heights.rows() - 3 ||
        precision.weights.cols() != spline->heights.cols() - 3)
        object->refuse("weights", "expected " + std::to_string(spline->heights.rows() - 3) + " rows of " +
                                      std::to_string(spline->heights.cols() - 3) + ", one for each cell");
    if (precision.weights.minCoeff() < 0) object->refuse("weights", "has a negative weight");
    object->reject_unknown_keys();
    return precision;
}

// --- fit, touches, prediction ---

Value write_fit(const Surface& surface, double mm)
{
    Value fit;
    fit.set("method", surface.method).set("touch_sigma", surface.touch_sigma / mm);
    if (std::isfinite(surface.touch_sigma_dof)) fit.set("touch_freedom", surface.touch_sigma_dof);
    fit.set("rms", surface.rms / mm);
    if (std::isfinite(surface.goodness)) fit.set("goodness", surface.goodness);
    if (!surface.alternatives.empty()) fit.set("score", surface.score).set("weight", surface.weight);
    if (!surface.outliers.empty()) {
        const std::vector<double> outliers(surface.outliers.begin(), surface.outliers.end());
        fit.set("outliers", Value(Eigen::VectorXd(Eigen::VectorXd::Map(outliers.data(), outliers.size()))));
    }
    return fit.set("ignored", surface.ignored);
}

void read_fit(Reader reader, Surface& surface, double mm)
{
    surface.method = reader.text("method");
    surface.touch_sigma = reader.number("touch_sigma", core::Range::at_least(0)) * mm;
    surface.touch_sigma_dof =
        reader.number_or("touch_freedom", core::kInfinity, core::Range{2, kMaxTouches, false, true});
    surface.rms = reader.number("rms", core::Range::at_least(0)) * mm;
    surface.goodness = reader.number_or("goodness", core::kNaN, core::Range::between(0, 1));
    surface.ignored = reader.integer("ignored", 0, std::numeric_limits<int>::max());
    surface.score = reader.number_or("score", 0);
    surface.weight = reader.number_or("weight", 1, core::Range::between(0, 1));
    if (reader.has("outliers"))
        for (const double column : reader.vector("outliers")) {
            if (!(column >= 0 && column < kMaxTouches && column == std::floor(column)))
                reader.refuse("outliers", core::to_text(column) + " is not the index of a touch");
            surface.outliers.push_back(column);
        }
    reader.reject_unknown_keys();
}

Value write_touches(const Surface& surface, double mm)
{
    Eigen::MatrixXd rows(surface.touches.cols(), 4);
    rows << surface.touches.transpose() / mm, surface.roles.cast<double>();
    return rows;
}

void read_touches(Reader& reader, Surface& surface, double mm)
{
    if (!reader.has("touches")) return;
    const Eigen::MatrixXd rows = reader.matrix("touches", 4);
    if (rows.rows() == 0) reader.refuse("touches", "is empty");
    surface.touches = rows.leftCols(3).transpose() * mm;
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
        if (!(rows(i, 3) >= 0 && rows(i, 3) <= kMaxRole && rows(i, 3) == std::floor(rows(i, 3))))
            reader.refuse("touches[" + std::to_string(i) + "][3]", "is no touch role (0 to 5)");
    surface.roles = rows.col(3).cast<int>();
}

Value write_prediction(const Prediction& prediction, double mm)
{
    Value value;
    return value.set("method", prediction.method)
        .set("confidence", prediction.confidence)
        .set("shift", prediction.shift / mm)
        .set("clamped", prediction.clamped);
}

Prediction read_prediction(Reader reader, double mm)
{
    Prediction prediction;
    prediction.method = reader.choice("method", {"posterior", "wang"});
    prediction.confidence = reader.number("confidence", core::Range::between(0, 1));
    prediction.shift = reader.number("shift") * mm;
    prediction.clamped = reader.flag_or("clamped", false);
    reader.reject_unknown_keys();
    return prediction;
}

} // namespace

json::Value to_json(const Surface& surface)
{
    const double mm = surface.units.mm();
    Value value;
    value.set("kind", "surface").set("units", json::to_json(surface.units.length));
    value.set("shape", shape_to_json(surface.shape, mm));
    value.set("shift", surface.shift / mm);
    if (surface.prediction)
        value.set("predicted_band", surface.prediction->band / mm)
            .set("prediction", write_prediction(*surface.prediction, mm));
    value.set("fit", write_fit(surface, mm));
    if (surface.touches.cols() > 0) value.set("touches", write_touches(surface, mm));
    if (!surface.alternatives.empty()) value.set("alternatives", write_alternatives(surface, mm));
    if (surface.covariance.size() > 0) value.set("covariance", write_covariance(surface.covariance, surface.shape, mm));
    if (surface.precision) value.set("precision", write_precision(*surface.precision, mm));
    return value;
}

Surface parse_surface(json::Reader reader)
{
    reader.expect_kind("surface");
    Surface surface;
    surface.units.length = json::read_length_unit(reader);
    const double mm = surface.units.mm();
    surface.shape = parse_shape(reader.object("shape"), mm);
    surface.shift = reader.number_or("shift", 0) * mm;
    if (std::optional<Reader> prediction = reader.optional_object("prediction")) {
        surface.prediction = read_prediction(*prediction, mm);
        surface.prediction->band = reader.number("predicted_band", core::Range::at_least(0)) * mm;
    }
    if (std::optional<Reader> fit = reader.optional_object("fit")) read_fit(*fit, surface, mm);
    read_touches(reader, surface, mm);
    surface.covariance = read_covariance(reader, surface.shape, mm);
    surface.precision = read_precision(reader, surface, mm);
    if (reader.has("alternatives")) read_alternatives(reader, surface, mm);
    for (const Eigen::Index column : surface.outliers)
        if (column >= surface.touches.cols()) reader.refuse("fit.outliers", "there are fewer touches");
    reader.reject_unknown_keys();
    return surface;
}

Surface read_surface(const std::string& path) { return parse_surface(json::Reader::open(path)); }

} // namespace fettle::surface
