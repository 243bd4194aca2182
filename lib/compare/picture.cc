#include "compare/picture.h"

#include "cloud/fields.h"
#include "compare/picture_parts.h"
#include "compare/statistics.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// The sheet, in pixels: the map in its frame, the legend to the right, a line of numbers below.
// Of the largest value: ticks nearer to each other would need more digits than a label shows.
constexpr double kLabelled = 1e-9;
constexpr double kMapWidth = 900, kMapHeight = 680, kLeastMapHeight = 360;
constexpr double kLeft = 84, kTop = 78, kBelowMap = 122, kLegendWidth = 310;
constexpr Rgb kBackground = {228, 228, 232}; // darker than no error, lighter than undefined

/// The next of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below x.
double round_up(double x)
{
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (digit * power >= x * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

std::string unit_of(const std::string& field, const Units& units)
{
    const Dimension d = field == "z" ? Dimension{1, 0} : field_dimension(field);
    const std::string length = to_string(units.length), force = to_string(units.force);
    if (d.force_power == 0 && d.length_power == 0) return "";
    if (d.force_power == 0 && field == "feed") return length + "/s";
    if (d.force_power == 0) return length;
    return force + (d.length_power == 0 ? "" : "/" + length + std::to_string(-d.length_power));
}

Scale scale_for(const Eigen::VectorXd& values, const PictureOptions& options)
{
    Scale scale;
    scale.bands = options.bands;
    scale.diverging = options.field == "error";
    if (scale.diverging) {
        scale.high = options.scale ? *options.scale : round_up(colour_scale(values, 0).limit);
        scale.low = -scale.high;
        return scale;
    }
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double value : values)
        if (std::isfinite(value)) {
            least = std::min(least, value);
            most = std::max(most, value);
        }
    scale.low = std::isfinite(least) ? least : 0;
    const double span = options.scale ? *options.scale : most - least;
    // All alike (or nothing): a scale that can still be labelled.
    scale.high = scale.low + (std::isfinite(span) && span > kLabelled * std::max(1.0, std::abs(most)) ? span : 1);
    return scale;
}

/// @param xy  2xN, what must be seen   @param spacing  of points that are drawn as cells, mm; 0: they are no points
Layout lay_out(const Eigen::Matrix2Xd& xy, double spacing)
{
    Eigen::AlignedBox2d box;
    for (const Vector2d& p : xy.colwise())
        if (p.allFinite()) box.extend(p);
    if (box.isEmpty()) throw InputError("no point has a finite x and y: there is nothing to draw");
    box = Eigen::AlignedBox2d(box.min() - Vector2d::Constant(spacing / 2), box.max() + Vector2d::Constant(spacing / 2));
    // A line of points is drawn as a strip.
    constexpr double kLeastSide = 1e-3;
    const Vector2d size = box.sizes().cwiseMax(kLeastSide * box.sizes().maxCoeff());
    Layout layout;
    layout.view.pixel = std::max(size.x() / kMapWidth, size.y() / kMapHeight);
    // Less the rounding of a whole number of pixels.
    const Eigen::Array2i pixels = (size / layout.view.pixel).array().round().cast<int>().max(1);
    layout.view.columns = pixels.x();
    layout.view.rows = pixels.y();
    layout.view.least = box.min();
    layout.map_corner = {kLeft, kTop};
    layout.map_size = {kMapWidth, std::max(kLeastMapHeight, double(pixels.y()))};
    layout.drawn_at = (layout.map_corner + (layout.map_size - pixels.matrix().cast<double>()) / 2).array().floor();
    return layout;
}

/// How far from a point its colour reaches, mm.
double reach_of(Index points, double spacing, double pixel)
{
    // A cell's corner is 0.71 spacings from its point; the rest bridges uneven scans. Few points are shown as dots.
    constexpr double kReach = 0.8, kLeastPixels = 0.75, kDotPixels = 7;
    constexpr Index kFew = 100;
    return points < kFew ? kDotPixels * pixel : std::max(kReach * spacing, kLeastPixels * pixel);
}

/// The numbers that lie inside B, or all of them.
Eigen::VectorXd judged(const Eigen::Matrix2Xd& xy, const Eigen::VectorXd& numbers, const std::optional<Job>& job)
{
    if (!job) return numbers;
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, xy.cols());
    points.topRows<2>() = xy;
    const std::vector<Region> places = regions(*job, points);
    std::vector<double> chosen;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] == Region::inside) chosen.push_back(numbers[static_cast<Index>(i)]);
    return Eigen::Map<Eigen::VectorXd>(chosen.data(), static_cast<Index>(chosen.size()));
}

/// A map ready to be coloured.
struct Drawing {
    Layout layout;
    Raster raster;    ///< in the units of the picture
    double smoothing; ///< of its shades, pixels
    Values values;
};

Drawing draw(const Cloud& cloud, const PictureOptions& options)
{
    Drawing d;
    const Eigen::Matrix2Xd xy = cloud.xyz.topRows<2>();
    const bool heights = options.field == "z";
    const Eigen::VectorXd numbers =
        heights ? Eigen::VectorXd(cloud.xyz.row(2) / options.units.mm())
                : Eigen::VectorXd(field(cloud, options.field) / to_base(options.units, field_dimension(options.field)));
    const double spacing = point_spacing(xy);
    constexpr double kAlone = 1; // the room of a single place, mm
    d.layout = lay_out(xy, spacing > 0 ? spacing : kAlone);
    const double pixel = d.layout.view.pixel;
    const double reach = reach_of(xy.cols(), spacing, pixel);
    d.raster = rasterise(d.layout.view, xy, numbers, reach);
    d.smoothing = std::max(0.7, spacing / pixel / 2); // half a cell: no steps are left
    d.values.numbers = judged(xy, numbers, options.within);
    return d;
}

Drawing draw(const Mesh& mesh, const PictureOptions& options)
{
    if (options.field != "z") throw InputError("a mesh has no field '" + options.field + "', only z");
    Drawing d;
    d.layout = lay_out(mesh.vertices.topRows<2>(), 0);
    const View& view = d.layout.view;
    d.raster = rasterise(view, mesh);
    d.raster.value /= options.units.mm();
    d.smoothing = 0.7;
    // What is seen counts, each place as much as the next; vertices would count where the mesh is fine, and underneath.
    Eigen::Matrix2Xd xy(2, d.raster.covered.count());
    Eigen::VectorXd numbers(xy.cols());
    for (Index column = 0, k = 0; column < view.columns; ++column)
        for (Index row = 0; row < view.rows; ++row)
            if (d.raster.covered(row, column)) {
                xy.col(k) = view.least + view.pixel * Vector2d(double(column) + 0.5, double(view.rows - row) - 0.5);
                numbers[k++] = d.raster.value(row, column);
            }
    d.values.numbers = judged(xy, numbers, options.within);
    return d;
}

void draw_map(Canvas& sheet, const Drawing& d, const Scale& scale, double mm)
{
    const View& view = d.layout.view;
    Eigen::ArrayXXd shade = Eigen::ArrayXXd::Ones(view.rows, view.columns);
    if (d.values.name == "z") shade = hill_shading(d.raster, view.pixel / mm, d.smoothing);
    const Eigen::Vector2i corner = d.layout.drawn_at.cast<int>();
    for (int row = 0; row < view.rows; ++row)
        for (int column = 0; column < view.columns; ++column) {
            if (!d.raster.covered(row, column)) continue;
            Rgb colour = scale(d.raster.value(row, column));
            // Shades keep a quarter of the colour, lights go at most half-way to white: the value stays legible.
            const double s = shade(row, column);
            if (s != 1)
                for (std::uint8_t& c : colour)
                    c = static_cast<std::uint8_t>(
                        std::lround(s < 1 ? c * (0.25 + 0.75 * s) : std::lerp(double(c), 255, std::min(0.5, s - 1))));
            sheet.dot(corner.x() + column, corner.y() + row, colour);
        }
}

} // namespace

std::string picture(const std::variant<Cloud, Mesh>& part, const PictureOptions& options)
{
    Drawing d = std::visit([&](const auto& p) { return draw(p, options); }, part);
    d.values.name = options.field;
    d.values.unit = unit_of(options.field, options.units);
    const Scale scale = scale_for(d.values.numbers, options);
    const Layout& layout = d.layout;

    Canvas sheet(static_cast<int>(kLeft + layout.map_size.x() + kLegendWidth),
                 static_cast<int>(kTop + layout.map_size.y() + kBelowMap));
    sheet.box(layout.map_corner, layout.map_size, kBackground);
    draw_map(sheet, d, scale, options.units.mm());
    if (options.within) draw_outlines(sheet, layout, *options.within);
    draw_axes(sheet, layout, options.units);
    draw_legend(sheet, layout, d.values, scale);
    draw_numbers(sheet, layout, d.values, options.within ? "inside B" : "");
    sheet.text(options.title, {kLeft, kTop - 38}, kTitle, Canvas::kInk, Canvas::Align::left, true);
    return sheet.png();
}

} // namespace fettle
