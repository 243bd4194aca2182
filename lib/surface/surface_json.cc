#include "core/error.h"
#include "core/text.h"
#include "surface/shape_json.h"
#include "surface/surface.h"
#include "json/units.h"

#include <cmath>
#include <limits>

namespace fettle {

namespace {

constexpr int kMostRoles = 5;
constexpr double kMostTouches = 1e9;

using json::Reader;
using json::Value;

// --- covariance: the lower triangle, row by row; C_ij has the dimension of θ_i θ_j ---

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
    const Eigen::VectorXd packed = reader.vector("covariance", static_cast<int>(n * (n + 1) / 2));
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0, k = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j, ++k) covariance(i, j) = covariance(j, i) = packed[k] * unit[i] * unit[j];
    if (covariance.diagonal().minCoeff() < 0) reader.refuse("covariance", "has a negative variance");
    return covariance;
}

// --- the alternatives ---

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
        other.weight = one.number("weight", Range::between(0, 1));
        if (other.weight > 0) {
            other.shape = parse_shape(one.object("shape"), mm);
            other.covariance = read_covariance(one, other.shape, mm);
            if (other.covariance.size() == 0) one.refuse("covariance", "is missing");
        }
        one.done();
        sum += other.weight;
        surface.alternatives.push_back(std::move(other));
    }
    constexpr double kRounding = 1e-9; // numbers are written to all their digits
    if (std::abs(sum - 1) > kRounding) reader.refuse("alternatives", "weights do not sum up to 1 with that of the fit");
}

// --- precision: weights to four digits, which is 1e-4 of a sigma ---

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
    std::optional<Reader> object = reader.object_or_none("precision");
    if (!object) return std::nullopt;
    const Bspline* spline = std::get_if<Bspline>(&surface.shape);
    if (spline == nullptr) object->refuse("", "belongs to a shape of type bspline");
    if (surface.covariance.size() > 0) object->refuse("", "stands beside covariance: one of the two");
    SplinePrecision precision;
    precision.amplitude = object->number("amplitude", Range::positive()) / mm;
    precision.weights = object->matrix("weights") / (mm * mm);
    if (precision.weights.rows() != spline->heights.rows() - 3 ||
        precision.weights.cols() != spline->heights.cols() - 3)
        object->refuse("weights", "expected " + std::to_string(spline->heights.rows() - 3) + " rows of " +
                                      std::to_string(spline->heights.cols() - 3) + ", one for each cell");
    if (precision.weights.minCoeff() < 0) object->refuse("weights", "has a negative weight");
    object->done();
    return precision;
}

// --- the fit, the touches, the prediction ---

Value write_fit(const Surface& surface, double mm)
{
    Value fit;
    fit.set("method", surface.method).set("touch_sigma", surface.touch_sigma / mm);
    if (std::isfinite(surface.touch_freedom)) fit.set("touch_freedom", surface.touch_freedom);
    fit.set("rms", surface.rms / mm);
    if (std::isfinite(surface.goodness)) fit.set("goodness", surface.goodness);
    if (!surface.alternatives.empty()) fit.set("score", surface.score).set("weight", surface.weight);
    if (!surface.gross_errors.empty()) {
        Eigen::VectorXd columns(static_cast<Eigen::Index>(surface.gross_errors.size()));
        for (Eigen::Index i = 0; i < columns.size(); ++i)
            columns[i] = static_cast<double>(surface.gross_errors[static_cast<std::size_t>(i)]);
        fit.set("gross_errors", columns);
    }
    return fit.set("ignored", surface.ignored);
}

void read_fit(Reader reader, Surface& surface, double mm)
{
    surface.method = reader.text("method");
    surface.touch_sigma = reader.number("touch_sigma", Range::at_least(0)) * mm;
    surface.touch_freedom =
        reader.number_or("touch_freedom", std::numeric_limits<double>::infinity(), Range{2, kMostTouches, false, true});
    surface.rms = reader.number("rms", Range::at_least(0)) * mm;
    surface.goodness = reader.number_or("goodness", std::numeric_limits<double>::quiet_NaN(), Range::between(0, 1));
    surface.ignored = reader.integer("ignored", 0, std::numeric_limits<int>::max());
    surface.score = reader.number_or("score", 0);
    surface.weight = reader.number_or("weight", 1, Range::between(0, 1));
    if (reader.has("gross_errors"))
        for (const double column : reader.vector("gross_errors")) {
            if (!(column >= 0 && column < kMostTouches && column == std::floor(column)))
                reader.refuse("gross_errors", to_text(column) + " is no number of a touch");
            surface.gross_errors.push_back(static_cast<Eigen::Index>(column));
        }
    reader.done();
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
        if (!(rows(i, 3) >= 0 && rows(i, 3) <= kMostRoles && rows(i, 3) == std::floor(rows(i, 3))))
            reader.refuse("touches[" + std::to_string(i) + "][3]", "is no role (0 to 5)");
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
    prediction.confidence = reader.number("confidence", Range::between(0, 1));
    prediction.shift = reader.number("shift") * mm;
    prediction.clamped = reader.flag_or("clamped", false);
    reader.done();
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
    if (std::optional<Reader> prediction = reader.object_or_none("prediction")) {
        surface.prediction = read_prediction(*prediction, mm);
        surface.prediction->band = reader.number("predicted_band", Range::at_least(0)) * mm;
    }
    if (std::optional<Reader> fit = reader.object_or_none("fit")) read_fit(*fit, surface, mm);
    read_touches(reader, surface, mm);
    surface.covariance = read_covariance(reader, surface.shape, mm);
    surface.precision = read_precision(reader, surface, mm);
    if (reader.has("alternatives")) read_alternatives(reader, surface, mm);
    for (const Eigen::Index column : surface.gross_errors)
        if (column >= surface.touches.cols()) reader.refuse("fit.gross_errors", "there are fewer touches");
    reader.done();
    return surface;
}

Surface read_surface(const std::string& path) { return parse_surface(json::Reader::open(path)); }

} // namespace fettle
