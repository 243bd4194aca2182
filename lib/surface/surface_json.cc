#include "core/error.h"
#include "core/text.h"
#include "surface/griddata.h"
#include "surface/shapes.h"
#include "surface/tensor_bspline.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace fettle {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Directions are read to full precision; a vector that is further from unit length was edited.
constexpr double kUnitSlack = 1e-9;
constexpr int kMostRoles = 5;
constexpr double kMostTouches = 1e9;

using json::Reader;
using json::Value;

// --- shapes: lengths are divided by `mm` when written, multiplied by it when read ---

Value write(const Plane& plane, double mm)
{
    Value value;
    return value.set("type", "plane")
        .set("origin", Value(Eigen::VectorXd(plane.origin / mm)))
        .set("z0", plane.z0 / mm)
        .set("slope", Value(Eigen::VectorXd(plane.slope)));
}

Value write(const Sphere& sphere, double mm)
{
    Value value;
    return value.set("type", "sphere")
        .set("point", Value(Eigen::VectorXd(sphere.point / mm)))
        .set("normal", Value(Eigen::VectorXd(sphere.normal)))
        .set("curvature", sphere.curvature * mm);
}

Value write(const Cylinder& cylinder, double mm)
{
    Value value;
    return value.set("type", "cylinder")
        .set("point", Value(Eigen::VectorXd(cylinder.point / mm)))
        .set("normal", Value(Eigen::VectorXd(cylinder.normal)))
        .set("axis", Value(Eigen::VectorXd(cylinder.axis)))
        .set("curvature", cylinder.curvature * mm);
}

Value write(const Cone& cone, double mm)
{
    Value value;
    return value.set("type", "cone")
        .set("point", Value(Eigen::VectorXd(cone.point / mm)))
        .set("normal", Value(Eigen::VectorXd(cone.normal)))
        .set("axis", Value(Eigen::VectorXd(cone.axis)))
        .set("around", cone.around * mm)
        .set("lean_deg", cone.lean / kDegree);
}

Value write(const Torus& torus, double mm)
{
    Value value;
    return value.set("type", "torus")
        .set("point", Value(Eigen::VectorXd(torus.point / mm)))
        .set("normal", Value(Eigen::VectorXd(torus.normal)))
        .set("axis", Value(Eigen::VectorXd(torus.axis)))
        .set("around", torus.around * mm)
        .set("lean_deg", torus.lean / kDegree)
        .set("along", torus.along * mm);
}

Value write(const Polynomial& polynomial, double mm)
{
    Value value;
    return value.set("type", "polynomial")
        .set("origin", Value(Eigen::VectorXd(polynomial.origin / mm)))
        .set("scale", polynomial.scale / mm)
        .set("coefficients", Value(Eigen::VectorXd(polynomial.coefficients / mm)));
}

Value write(const Swept& swept, double mm)
{
    Value value;
    return value.set("type", "swept")
        .set("origin", Value(Eigen::VectorXd(swept.origin / mm)))
        .set("ruling", Value(Eigen::VectorXd(swept.ruling)))
        .set("scale", swept.scale / mm)
        .set("section", Value(Eigen::VectorXd(swept.section / mm)))
        .set("slope", swept.slope)
        .set("section_least", swept.section_least / mm)
        .set("section_most", swept.section_most / mm);
}

Value write(const Bspline& bspline, double mm)
{
    Value value;
    return value.set("type", "bspline")
        .set("angle_deg", bspline.angle / kDegree)
        .set("origin", Value(Eigen::VectorXd(bspline.origin / mm)))
        .set("cell", Value(Eigen::VectorXd(bspline.cell / mm)))
        .set("heights", Value(Eigen::MatrixXd(bspline.heights / mm)));
}

Value write(const TensorBspline& bspline, double mm)
{
    Value value;
    return value.set("type", "tensor-bspline")
        .set("angle_deg", bspline.angle / kDegree)
        .set("knots_u", Value(Eigen::VectorXd(bspline.knots_u / mm)))
        .set("knots_v", Value(Eigen::VectorXd(bspline.knots_v / mm)))
        .set("heights", Value(Eigen::MatrixXd(bspline.heights / mm)));
}

Value write(const Griddata& griddata, double mm)
{
    Value value;
    return value.set("type", "griddata")
        .set("points", Value(Eigen::MatrixXd(griddata.points.transpose() / mm)))
        .set("spacing", griddata.spacing / mm)
        .set("angle_deg", griddata.angle / kDegree);
}

Eigen::VectorXd read_unit(Reader& reader, const std::string& key, int size)
{
    const Eigen::VectorXd direction = reader.vector(key, size);
    if (std::abs(direction.norm() - 1) > kUnitSlack) reader.refuse(key, "must have length 1");
    return direction;
}

Eigen::Vector3d read_upward(Reader& reader)
{
    const Eigen::Vector3d normal = read_unit(reader, "normal", 3);
    if (normal.z() <= 0) reader.refuse("normal", "must point up");
    return normal;
}

Eigen::Vector3d read_axis(Reader& reader, const Eigen::Vector3d& normal)
{
    const Eigen::Vector3d axis = read_unit(reader, "axis", 3);
    if (std::abs(axis.dot(normal)) > kUnitSlack) reader.refuse("axis", "must be perpendicular to normal");
    return axis;
}

Shape read_cylinder(Reader& reader, double mm)
{
    const Eigen::Vector3d point = reader.vector("point", 3) * mm;
    const Eigen::Vector3d normal = read_upward(reader);
    return Cylinder{point, normal, read_axis(reader, normal), reader.number("curvature") / mm};
}

Cone read_cone(Reader& reader, double mm)
{
    const Eigen::Vector3d point = reader.vector("point", 3) * mm;
    const Eigen::Vector3d normal = read_upward(reader);
    return {point, normal, read_axis(reader, normal), reader.number("around") / mm,
            reader.number("lean_deg") * kDegree};
}

Shape read_torus(Reader& reader, double mm)
{
    const Cone cone = read_cone(reader, mm);
    return Torus{cone.point, cone.normal, cone.axis, cone.around, cone.lean, reader.number("along") / mm};
}

Shape read_polynomial(Reader& reader, double mm)
{
    Polynomial polynomial;
    polynomial.origin = reader.vector("origin", 2) * mm;
    polynomial.scale = reader.number("scale", Range::positive()) * mm;
    polynomial.coefficients = reader.vector("coefficients") * mm;
    if (polynomial.coefficients.size() != monomials(degree(polynomial)))
        reader.refuse("coefficients", "expected 1, 3, 6, 10, … numbers: all of a total degree");
    return polynomial;
}

Shape read_swept(Reader& reader, double mm)
{
    Swept swept;
    swept.origin = reader.vector("origin", 2) * mm;
    swept.ruling = read_unit(reader, "ruling", 2);
    swept.scale = reader.number("scale", Range::positive()) * mm;
    swept.section = reader.vector("section", 4) * mm;
    swept.slope = reader.number("slope");
    swept.section_least = reader.number("section_least") * mm;
    swept.section_most = reader.number("section_most", Range::at_least(swept.section_least / mm)) * mm;
    return swept;
}

Shape read_bspline(Reader& reader, double mm)
{
    Bspline bspline;
    bspline.angle = reader.number("angle_deg") * kDegree;
    bspline.origin = reader.vector("origin", 2) * mm;
    bspline.cell = reader.vector("cell", 2) * mm;
    if (bspline.cell.minCoeff() <= 0) reader.refuse("cell", "must be positive");
    bspline.heights = reader.matrix("heights") * mm;
    if (bspline.heights.rows() < 4 || bspline.heights.cols() < 4)
        reader.refuse("heights", "expected at least 4 rows of 4 (one cubic cell)");
    return bspline;
}

Shape read_tensor_bspline(Reader& reader, double mm)
{
    TensorBspline bspline;
    bspline.angle = reader.number("angle_deg") * kDegree;
    bspline.heights = reader.matrix("heights") * mm;
    const auto knots = [&](const std::string& key, Eigen::Index control) {
        const Eigen::VectorXd read = reader.vector(key) * mm;
        if (const std::string wrong = wrong_with_knots(read, control); !wrong.empty()) reader.refuse(key, wrong);
        return read;
    };
    bspline.knots_u = knots("knots_u", bspline.heights.rows());
    bspline.knots_v = knots("knots_v", bspline.heights.cols());
    return bspline;
}

Shape read_griddata(Reader& reader, double mm)
{
    const Eigen::Matrix3Xd points = reader.matrix("points", 3).transpose() * mm;
    const double spacing = reader.number("spacing", Range::at_least(0)) * mm;
    const double angle = reader.number("angle_deg") * kDegree;
    try {
        return make_griddata(points, spacing, angle);
    } catch (const InputError& error) {
        reader.refuse("points", error.what());
    }
}

Shape read_shape(Reader reader, double mm)
{
    const std::string type = reader.choice("type", {"plane", "sphere", "cylinder", "cone", "torus", "polynomial",
                                                    "swept", "bspline", "tensor-bspline", "griddata"});
    Shape shape;
    if (type == "plane")
        shape = Plane{reader.vector("origin", 2) * mm, reader.number("z0") * mm, reader.vector("slope", 2)};
    else if (type == "sphere")
        shape = Sphere{reader.vector("point", 3) * mm, read_upward(reader), reader.number("curvature") / mm};
    else if (type == "cylinder")
        shape = read_cylinder(reader, mm);
    else if (type == "cone")
        shape = read_cone(reader, mm);
    else if (type == "torus")
        shape = read_torus(reader, mm);
    else if (type == "polynomial")
        shape = read_polynomial(reader, mm);
    else if (type == "swept")
        shape = read_swept(reader, mm);
    else if (type == "bspline")
        shape = read_bspline(reader, mm);
    else if (type == "tensor-bspline")
        shape = read_tensor_bspline(reader, mm);
    else
        shape = read_griddata(reader, mm);
    reader.done();
    return shape;
}

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

Value write_shape(const Shape& shape, double mm)
{
    return std::visit([mm](const auto& s) { return write(s, mm); }, shape);
}

// --- the alternatives ---

Value write_alternatives(const Surface& surface, double mm)
{
    std::vector<Value> list;
    for (const Alternative& other : surface.alternatives) {
        Value value;
        value.set("method", other.method).set("score", other.score).set("weight", other.weight);
        if (other.weight > 0)
            value.set("shape", write_shape(other.shape, mm))
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
            other.shape = read_shape(one.object("shape"), mm);
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
    fit.set("method", surface.method).set("touch_sigma", surface.touch_sigma / mm).set("rms", surface.rms / mm);
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
    surface.roles = rows.col(3).cast<int>();
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
        if (surface.roles[i] != rows(i, 3) || surface.roles[i] < 0 || surface.roles[i] > kMostRoles)
            reader.refuse("touches[" + std::to_string(i) + "][3]", "is no role (0 to 5)");
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
    Value units;
    units.set("length", to_string(surface.units.length));
    Value value;
    value.set("kind", "surface").set("units", units);
    value.set("shape", write_shape(surface.shape, mm));
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
    Reader units = reader.object("units");
    surface.units.length = parse_length_unit(units.choice("length", {"mm", "in", "m"}));
    units.done();
    const double mm = surface.units.mm();
    surface.shape = read_shape(reader.object("shape"), mm);
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
