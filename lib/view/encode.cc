#include "view/encode.h"

#include "core/decompositions.h"
#include "core/morton.h"
#include "draw/base64.h"
#include "draw/raster.h"
#include "geometry/point_index.h"

#include <tbb/parallel_for.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace fettle::view {
namespace {

using Eigen::Index;

constexpr int kMaxCode = 65534; ///< of a defined number; the next one stands for undefined

/// Integers of 16 bits for numbers from `origin` on, in steps of `step`.
struct Quantisation {
    double origin = 0, step = 0;

    std::uint16_t operator()(double number) const
    {
        if (!std::isfinite(number)) return kMaxCode + 1;
        return step > 0
                   ? static_cast<std::uint16_t>(std::clamp(std::round((number - origin) / step), 0.0, double(kMaxCode)))
                   : 0;
    }
};

/// @param whole  numbers are integers, and keep their values if there is room for them
Quantisation quantisation(const Eigen::VectorXd& numbers, bool whole)
{
    double min = std::numeric_limits<double>::infinity(), max = -min;
    for (const double number : numbers)
        if (std::isfinite(number)) {
            min = std::min(min, number);
            max = std::max(max, number);
        }
    if (!(min <= max)) return {};
    return {min, whole && max - min <= kMaxCode ? 1 : (max - min) / kMaxCode};
}

/// Order of the points in the page, columns of part.points: along a Morton curve, or, of a mesh, as triangles that
/// follow such a curve need them, so that most corners are new or near.
struct PageOrder {
    std::vector<Index> points;
    std::vector<Index> triangles;
};

PageOrder page_order(const mesh::CloudMesh& part)
{
    PageOrder order;
    if (!part.is_mesh()) {
        for (const std::uint32_t i : core::morton_order(part.points.xyz))
            if (part.points.xyz.col(i).allFinite()) order.points.push_back(i);
        return order;
    }
    Eigen::Matrix3Xd centres(3, part.triangles.cols());
    for (Index t = 0; t < centres.cols(); ++t)
        centres.col(t) = part.points.xyz(Eigen::all, part.triangles.col(t)).rowwise().mean();
    std::vector<char> is_used(static_cast<std::size_t>(part.points.size()), 0);
    for (const std::uint32_t t : core::morton_order(centres)) {
        order.triangles.push_back(t);
        for (const int corner : part.triangles.col(t))
            if (char& used = is_used[static_cast<std::size_t>(corner)]; used == 0) {
                used = 1;
                order.points.push_back(corner);
            }
    }
    return order;
}

/// Unit normals for the light: those of the points, else of a plane through their neighbours, up to their sign.
Eigen::Matrix3Xd light_normals(const cloud::Cloud& points)
{
    if (cloud::has_normals(points)) return cloud::normals(points);
    constexpr Index kNeighbours = 9;
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, points.size());
    if (points.size() < kNeighbours) return normals;
    const geometry::PointIndex<3> index(points.xyz);
    tbb::parallel_for(Index{0}, points.size(), [&](Index i) {
        if (!points.xyz.col(i).allFinite()) return;
        const Eigen::Matrix3Xd near = points.xyz(Eigen::all, index.nearest(points.xyz.col(i), kNeighbours));
        const Eigen::Matrix3Xd centred = near.colwise() - near.rowwise().mean();
        const core::SymmetricEigen<3> axes = core::symmetric_eigen(Eigen::Matrix3d(centred * centred.transpose()));
        normals.col(i) = axes.vectors.col(0);
    });
    return normals;
}

class Block {
  public:
    void add16(const std::vector<std::uint16_t>& column)
    {
        std::vector<std::uint16_t> differences(column.size());
        std::uint16_t before = 0;
        for (std::size_t i = 0; i < column.size(); ++i) {
            differences[i] = static_cast<std::uint16_t>(column[i] - before);
            before = column[i];
        }
        for (const int shift : {0, 8})
            for (const std::uint16_t d : differences) bytes_ += static_cast<char>(d >> shift & 0xff);
    }
    void add8(char byte) { bytes_ += byte; }
    /// Corners of triangles, numbered in the order in which they appear.
    void add_corners(const std::vector<std::uint32_t>& corners)
    {
        std::vector<std::uint32_t> back(corners.size());
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            back[i] = next - corners[i];
            if (back[i] == 0) ++next;
        }
        for (const int shift : {0, 8, 16, 24})
            for (const std::uint32_t b : back) bytes_ += static_cast<char>(b >> shift & 0xff);
    }
    /// Deflated, in base64.
    std::string packed() const
    {
        uLongf size = compressBound(bytes_.size());
        std::string deflated(size, '\0');
        constexpr int kLevel = 6; // the highest takes three times as long for one percent
        if (compress2(reinterpret_cast<Bytef*>(deflated.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                      bytes_.size(), kLevel) != Z_OK)
            throw std::runtime_error("zlib cannot compress the points of a page");
        deflated.resize(size);
        return draw::base64(deflated);
    }

  private:
    std::string bytes_;
};

/// Octahedral coordinates of a unit normal, -1 to 1; 0, 0 for none (which is z, as good as any).
Eigen::Vector2d octahedral(const Eigen::Vector3d& normal)
{
    const double sum = normal.cwiseAbs().sum();
    if (!(sum > 0)) return {0, 0};
    const Eigen::Vector3d n = normal / sum;
    if (n.z() >= 0) return n.head<2>();
    return {(1 - std::abs(n.y())) * (n.x() < 0 ? -1 : 1), (1 - std::abs(n.x())) * (n.y() < 0 ? -1 : 1)};
}

void add_normals(Block& block, const cloud::Cloud& points, const std::vector<Index>& order)
{
    const Eigen::Matrix3Xd normals = light_normals(points);
    constexpr double kMaxByte = 127;
    for (const int axis : {0, 1})
        for (const Index i : order)
            block.add8(static_cast<char>(std::lround(kMaxByte * octahedral(normals.col(i))[axis])));
}

json::Value add_field(Block& block, const ShownField& field, const std::vector<Index>& order)
{
    json::Value description = field.description;
    if (field.scale.packed) {
        for (const int channel : {0, 1, 2})
            for (const Index i : order)
                block.add8(static_cast<char>(draw::unpacked(field.numbers[i])[std::size_t(channel)]));
        return description.set("kind", "rgb");
    }
    const Quantisation quantised = quantisation(field.numbers, !field.scale.classes.empty());
    description.set("kind", "number").set("origin", quantised.origin).set("step", quantised.step);
    std::vector<std::uint16_t> column;
    for (const Index i : order) column.push_back(quantised(field.numbers[i]));
    block.add16(column);
    return description;
}

} // namespace

EncodedLayer encode_layer(const mesh::CloudMesh& part, const std::vector<ShownField>& fields, double mm)
{
    const PageOrder order = page_order(part);
    Block block;
    Eigen::Vector3d origin, step;
    for (const int axis : {0, 1, 2}) {
        Eigen::VectorXd column(Index(order.points.size()));
        for (Index k = 0; k < column.size(); ++k) column[k] = part.points.xyz(axis, order.points[std::size_t(k)]) / mm;
        const Quantisation quantised = quantisation(column, false);
        origin[axis] = quantised.origin;
        step[axis] = quantised.step;
        std::vector<std::uint16_t> codes;
        for (const double number : column) codes.push_back(quantised(number));
        block.add16(codes);
    }
    EncodedLayer encoded;
    encoded.description.set("count", Index(order.points.size()))
        .set("triangles", part.triangles.cols())
        .set("origin", Eigen::VectorXd(origin))
        .set("step", Eigen::VectorXd(step))
        .set("spacing", draw::point_spacing(part.points.xyz) / mm)
        .set("normals", !part.is_mesh());
    if (!part.is_mesh()) add_normals(block, part.points, order.points);
    std::vector<json::Value> shown;
    for (const ShownField& field : fields) shown.push_back(add_field(block, field, order.points));
    encoded.description.set("fields", shown);
    std::vector<std::uint32_t> number_of(static_cast<std::size_t>(part.points.size()), 0);
    for (std::size_t k = 0; k < order.points.size(); ++k)
        number_of[static_cast<std::size_t>(order.points[k])] = static_cast<std::uint32_t>(k);
    std::vector<std::uint32_t> corners;
    for (const Index t : order.triangles)
        for (const int corner : part.triangles.col(t)) corners.push_back(number_of[static_cast<std::size_t>(corner)]);
    block.add_corners(corners);
    encoded.block = block.packed();
    return encoded;
}

} // namespace fettle::view
