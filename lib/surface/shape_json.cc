#include "surface/shape_json.h"

#include "core/constants.h"
#include "core/error.h"
#include "surface/griddata.h"
#include "surface/shapes.h"
#include "surface/tensor_bspline.h"

#include <algorithm>
#include <cmath>

namespace fettle::surface {

namespace {

using json::Reader;
using json::Value;

// Each shape lists its members once, in `visit_members(io, shape)`: a Writer writes them to a JSON value, a Parser
// reads them. Each has a power of length: with 1 the Writer divides by the file's unit of length, with -1 it
// multiplies.

class Writer {
  public:
    explicit Writer(double mm) : mm_(mm) {}
    double mm() const { return mm_; }

    void number(const char* key, double x, int power, const core::Range& = {}) { value_.set(key, in_unit(x, power)); }
    void angle(const char* key, double x) { value_.set(key, x / core::kRadPerDegree); }
    void vector(const char* key, const Eigen::VectorXd& v, int power) { value_.set(key, Value(in_unit(v, power))); }
    void matrix(const char* key, const Eigen::MatrixXd& m) { value_.set(key, Value(in_unit(m, 1))); }
    void points(const char* key, const Eigen::Matrix3Xd& m) { matrix(key, m.transpose()); }
    void lower_triangle(const char* key, const Eigen::Matrix3d& A, int power)
    {
        vector(key, (Eigen::VectorXd(6) << A(0, 0), A(1, 0), A(1, 1), A(2, 0), A(2, 1), A(2, 2)).finished(), power);
    }
    void direction(const char* key, const Eigen::VectorXd& v) { vector(key, v, 0); }
    void upward(const char* key, const Eigen::Vector3d& v) { vector(key, v, 0); }
    void across(const char* key, const Eigen::Vector3d& v, const Eigen::Vector3d&) { vector(key, v, 0); }
    Value& value() { return value_; }

  private:
    template <typename T>
    T in_unit(const T& x, int power) const
    {
        return power > 0 ? T(x / mm_) : power < 0 ? T(x * mm_) : x;
    }

    double mm_;
    Value value_;
};

class Parser {
  public:
    Parser(Reader& reader, double mm) : reader_(reader), mm_(mm) {}
    double mm() const { return mm_; }

    void number(const char* key, double& x, int power, const core::Range& range = {})
    {
        x = in_mm(reader_.number(key, range), power);
    }
    void angle(const char* key, double& x) { x = reader_.number(key) * core::kRadPerDegree; }
    template <typename Vector>
    void vector(const char* key, Vector& v, int power)
    {
        v = in_mm(reader_.vector(key, Vector::SizeAtCompileTime), power);
    }
    void matrix(const char* key, Eigen::MatrixXd& m) { m = reader_.matrix(key) * mm_; }
    void points(const char* key, Eigen::Matrix3Xd& m) { m = reader_.matrix(key, 3).transpose() * mm_; }
    void lower_triangle(const char* key, Eigen::Matrix3d& A, int power)
    {
        Eigen::Vector<double, 6> a;
        vector(key, a, power);
        A << a[0], a[1], a[3], a[1], a[2], a[4], a[3], a[4], a[5];
    }
    template <typename Vector>
    void direction(const char* key, Vector& v)
    {
        vector(key, v, 0);
        if (std::abs(v.norm() - 1) > kUnitLengthTolerance) reader_.refuse(key, "must have length 1");
    }
    void upward(const char* key, Eigen::Vector3d& v)
    {
        direction(key, v);
        if (v.z() <= 0) reader_.refuse(key, "must point up");
    }
    void across(const char* key, Eigen::Vector3d& v, const Eigen::Vector3d& normal)
    {
        direction(key, v);
        if (std::abs(v.dot(normal)) > kUnitLengthTolerance) reader_.refuse(key, "must be perpendicular to normal");
    }

  private:
    // Directions are written with all digits; a vector that deviates more from unit length was edited.
    static constexpr double kUnitLengthTolerance = 1e-9;

    template <typename T>
    T in_mm(const T& x, int power) const
    {
        return power > 0 ? T(x * mm_) : power < 0 ? T(x / mm_) : x;
    }

    Reader& reader_;
    double mm_;
};

template <typename Io>
void visit_members(Io& io, Plane& plane)
{
    io.vector("origin", plane.origin, 1);
    io.number("z0", plane.z0, 1);
    io.vector("slope", plane.slope, 0);
}

template <typename Io>
void visit_members(Io& io, Sphere& sphere)
{
    io.vector("point", sphere.point, 1);
    io.upward("normal", sphere.normal);
    io.number("curvature", sphere.curvature, -1);
}

template <typename Io, typename Round>
void visit_frame(Io& io, Round& round)
{
    io.vector("point", round.point, 1);
    io.upward("normal", round.normal);
    io.across("axis", round.axis, round.normal);
}

template <typename Io>
void visit_members(Io& io, Cylinder& cylinder)
{
    visit_frame(io, cylinder);
    io.number("curvature", cylinder.curvature, -1);
}

template <typename Io>
void visit_members(Io& io, Cone& cone)
{
    visit_frame(io, cone);
    io.number("around", cone.curvature_around, -1);
    io.angle("lean_deg", cone.lean);
}

template <typename Io>
void visit_members(Io& io, Torus& torus)
{
    visit_frame(io, torus);
    io.number("around", torus.curvature_around, -1);
    io.angle("lean_deg", torus.lean);
    io.number("along", torus.curvature_along, -1);
}

template <typename Io>
void visit_members(Io& io, Quadric& quadric)
{
    io.vector("point", quadric.point, 1);
    io.upward("normal", quadric.normal);
    io.lower_triangle("form", quadric.form, -1);
}

template <typename Io>
void visit_members(Io& io, Polynomial& polynomial)
{
    io.vector("origin", polynomial.origin, 1);
    io.number("scale", polynomial.scale, 1, core::Range::positive());
    io.vector("coefficients", polynomial.coefficients, 1);
}

template <typename Io>
void visit_members(Io& io, Swept& swept)
{
    io.vector("origin", swept.origin, 1);
    io.direction("ruling", swept.ruling);
    io.number("scale", swept.scale, 1, core::Range::positive());
    io.vector("section", swept.section, 1);
    io.number("slope", swept.slope, 0);
    io.number("section_min", swept.section_min, 1);
    io.number("section_max", swept.section_max, 1, core::Range::at_least(swept.section_min / io.mm()));
}

template <typename Io>
void visit_members(Io& io, Bspline& bspline)
{
    io.angle("angle_deg", bspline.angle);
    io.vector("origin", bspline.origin, 1);
    io.vector("cell", bspline.cell, 1);
    io.matrix("heights", bspline.heights);
}

template <typename Io>
void visit_members(Io& io, TensorBspline& bspline)
{
    io.angle("angle_deg", bspline.angle);
    io.vector("knots_u", bspline.knots_u, 1);
    io.vector("knots_v", bspline.knots_v, 1);
    io.matrix("heights", bspline.heights);
}

template <typename Io>
void visit_members(Io& io, Griddata& griddata)
{
    io.points("points", griddata.points);
    io.number("spacing", griddata.spacing, 1, core::Range::at_least(0));
    io.angle("angle_deg", griddata.angle);
}

// --- conditions on several members, and what is derived from them ---

template <typename AnyShape>
void validate(const Reader&, AnyShape&)
{
}

void validate(const Reader& reader, Polynomial& polynomial)
{
    if (polynomial.coefficients.size() != monomial_count(degree(polynomial)))
        reader.refuse("coefficients", "expected 1, 3, 6, 10, … numbers: all of a total degree");
}

void validate(const Reader& reader, Bspline& bspline)
{
    if (bspline.cell.minCoeff() <= 0) reader.refuse("cell", "must be positive");
    if (bspline.heights.rows() < 4 || bspline.heights.cols() < 4)
        reader.refuse("heights", "expected at least 4 rows of 4 (one cubic cell)");
}

void validate(const Reader& reader, TensorBspline& bspline)
{
    const auto check = [&](const char* key, const Eigen::VectorXd& knots, Eigen::Index control) {
        if (const std::string problem = knot_problem(knots, control); !problem.empty()) reader.refuse(key, problem);
    };
    check("knots_u", bspline.knots_u, bspline.heights.rows());
    check("knots_v", bspline.knots_v, bspline.heights.cols());
}

void validate(const Reader& reader, Griddata& griddata)
{
    try {
        griddata = make_griddata(griddata.points, griddata.spacing, griddata.angle);
    } catch (const core::InputError& error) {
        reader.refuse("points", error.what());
    }
}

/// Names of the types, in the order of the alternatives of Shape.
const std::vector<std::string>& type_names()
{
    static const std::vector<std::string> names = {"plane",   "sphere",         "cylinder",   "cone",
                                                   "torus",   "quadric",        "polynomial", "swept",
                                                   "bspline", "tensor-bspline", "griddata"};
    return names;
}

/// Constructs the type in place: its members are not initialised yet, and must not be copied.
template <std::size_t... kTypes>
void emplace_type(Shape& shape, std::size_t type, std::index_sequence<kTypes...>)
{
    ((type == kTypes ? void(shape.emplace<kTypes>()) : void()), ...);
}

} // namespace

Value shape_to_json(const Shape& shape, double mm)
{
    Writer writer(mm);
    writer.value().set("type", type_names()[shape.index()]);
    std::visit([&](auto copy) { visit_members(writer, copy); }, shape);
    return std::move(writer.value());
}

Shape parse_shape(Reader reader, double mm)
{
    const std::vector<std::string>& names = type_names();
    const auto type = std::find(names.begin(), names.end(), reader.choice("type", names)) - names.begin();
    Shape shape;
    emplace_type(shape, type, std::make_index_sequence<std::variant_size_v<Shape>>());
    Parser parser(reader, mm);
    std::visit(
        [&](auto& one) {
            visit_members(parser, one);
            validate(reader, one);
        },
        shape);
    reader.reject_unknown_keys();
    return shape;
}

} // namespace fettle::surface
