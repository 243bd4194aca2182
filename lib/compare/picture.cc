#include "compare/picture.h"

#include "cloud/fields.h"
#include "compare/canvas.h"
#include "compare/picture_parts.h"
#include "compare/statistics.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Of the largest value: ticks nearer to each other would need more digits than a label shows.
constexpr double kLabelled = 1e-9;
// The sheet, in pixels: the map in its frame, the title above it, the legend to the right, a line of numbers below.
constexpr double kHeightPerWidth = 680.0 / 900, kLeastHeightPerWidth = 0.4, kLeastHeight = 290; // room for the legend
constexpr double kLeft = 84, kTop = 36, kTitleHeight = 42, kBelowMap = 122, kLegendWidth = 310;
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

bool from_above(const Eigen::Vector3d& from) { return from.head<2>().isZero(0) && from.z() > 0; }

/// @param seen  3xN, V, what must be seen   @param spacing  of points that are drawn as cells, mm; 0: they are no
/// points
Layout lay_out(const Eigen::Matrix3Xd& seen, double spacing, const PictureOptions& options)
{
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : seen.colwise())
        if (p.head<2>().allFinite()) box.extend(p.head<2>());
    if (box.isEmpty())
        throw InputError("no point has a finite " + std::string(from_above(options.from) ? "x and y" : "x, y and z") +
                         ": there is nothing to draw");
    if (options.within)
        for (const Eigen::Matrix3Xd* polygon : {&options.within->anomaly, &options.within->sampling}) {
            const Eigen::Matrix3Xd corners = in_view(view_rotation(options.from), outline(*polygon));
            for (const Eigen::Vector3d& p : corners.colwise()) box.extend(p.head<2>());
        }
    box = Eigen::AlignedBox2d(box.min() - Vector2d::Constant(spacing / 2), box.max() + Vector2d::Constant(spacing / 2));
    // A line of points is drawn as a strip.
    constexpr double kLeastSide = 1e-3;
    const Vector2d size = box.sizes().cwiseMax(kLeastSide * box.sizes().maxCoeff());
    Layout layout;
    layout.rotation_view_machine = view_rotation(options.from);
    layout.view.pixel = std::max(size.x() / options.width, size.y() / (kHeightPerWidth * options.width));
    // Less the rounding of a whole number of pixels.
    const Eigen::Array2i pixels = (size / layout.view.pixel).array().round().cast<int>().max(1);
    layout.view.columns = pixels.x();
    layout.view.rows = pixels.y();
    layout.view.least = box.min();
    layout.map_corner = {kLeft, kTop + (options.title.empty() ? 0 : kTitleHeight)};
    layout.map_size = {double(options.width),
                       std::max({kLeastHeightPerWidth * options.width, kLeastHeight, double(pixels.y())})};
    layout.drawn_at = (layout.map_corner + (layout.map_size - pixels.matrix().cast<double>()) / 2).array().floor();
    return layout;
}

/// How far from a point its colour reaches, mm.
double reach_of(Index points, double spacing, double pixel)
{
    // A cell's corner is 0.71 spacings from its point. Of points at random, one place in a hundred is farther than 1.1
    // from all of them. Few points are shown as dots.
    constexpr double kReach = 1.1, kLeastPixels = 0.75, kDotPixels = 7;
    constexpr Index kFew = 100;
    return points < kFew ? kDotPixels * pixel : std::max(kReach * spacing, kLeastPixels * pixel);
}

/// The numbers that lie inside B, or all of them. @param points  3xN, M
Eigen::VectorXd judged(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& numbers, const std::optional<Job>& job)
{
    if (!job) return numbers;
    Eigen::Matrix3Xd flat = points;
    flat.row(2).setZero(); // a point without a height still lies inside
    const std::vector<Region> places = regions(*job, flat);
    std::vector<double> chosen;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] == Region::inside) chosen.push_back(numbers[static_cast<Index>(i)]);
    return Eigen::Map<Eigen::VectorXd>(chosen.data(), static_cast<Index>(chosen.size()));
}

/// A map ready to be coloured.
struct Drawing {
    Layout layout;
    View view;        ///< of the raster: that of the layout, or a finer one
    Raster raster;    ///< in the units of the picture
    double smoothing; ///< of its shades, pixels
    Values values;
};

View finer(const View& view, int times)
{
    return {view.least, view.pixel / times, view.columns * times, view.rows * times};
}

Drawing draw(const Cloud& cloud, const PictureOptions& options)
{
    Drawing d;
    const double spacing = point_spacing(cloud.xyz);
    constexpr double kAlone = 1; // the room of a single place, mm
    const Eigen::Matrix3Xd seen = in_view(view_rotation(options.from), cloud.xyz);
    d.layout = lay_out(seen, spacing > 0 ? spacing : kAlone, options);
    const bool heights = options.field == "z";
    const Eigen::VectorXd numbers =
        heights ? Eigen::VectorXd(cloud.xyz.row(2) / options.units.mm())
                : Eigen::VectorXd(field(cloud, options.field) / to_base(options.units, field_dimension(options.field)));
    d.view = finer(d.layout.view, options.fineness);
    const double pixel = d.view.pixel;
    d.raster = rasterise(d.view, seen, numbers, reach_of(seen.cols(), spacing, d.layout.view.pixel));
    d.smoothing = std::max(0.7, spacing / pixel / 2); // half a cell: no steps are left
    d.values.numbers = judged(cloud.xyz, numbers, options.within);
    return d;
}

Drawing draw(const Mesh& mesh, const PictureOptions& options)
{
    if (options.field != "z") throw InputError("a mesh has no field '" + options.field + "', only z");
    Drawing d;
    const Eigen::Matrix3d rotation = view_rotation(options.from);
    const Mesh seen = {in_view(rotation, mesh.vertices), mesh.triangles};
    d.layout = lay_out(seen.vertices, 0, options);
    d.view = finer(d.layout.view, options.fineness);
    d.raster = rasterise(d.view, seen, mesh.vertices.row(2).transpose() / options.units.mm());
    d.smoothing = 0.7;
    if (!from_above(options.from)) { // the numbers do not depend on where one looks from
        PictureOptions above = options;
        above.from = Eigen::Vector3d::UnitZ();
        d.values.numbers = draw(mesh, above).values.numbers;
        return d;
    }
    // What is seen counts, each place as much as the next; vertices would count where the mesh is fine, and underneath.
    Eigen::Matrix3Xd places(3, d.raster.covered.count());
    Eigen::VectorXd numbers(places.cols());
    for (Index column = 0, k = 0; column < d.view.columns; ++column)
        for (Index row = 0; row < d.view.rows; ++row)
            if (d.raster.covered(row, column)) {
                places.col(k) << d.view.centre(row, column), d.raster.depth(row, column);
                numbers[k++] = d.raster.value(row, column);
            }
    d.values.numbers = judged(places, numbers, options.within);
    return d;
}

/// How much light and shade a picture bears. Heights from above all of it, as hills on a map; the colours of other
/// fields are read as numbers, so they are shaded only where the part's shape could not be told otherwise.
double shading_of(const PictureOptions& options)
{
    constexpr double kHeights = 0.75, kOthers = 0.5; // from the side: what turns away from the light is not black
    if (from_above(options.from)) return options.field == "z" ? 1 : 0;
    return options.field == "z" ? kHeights : kOthers;
}

/// Shades keep a quarter of the colour, lights go at most half-way to white: the value stays legible. Near-white means
/// "no error", so diverging colours get no lights.
/// @param shade  about 1 where the part faces the eye
Rgb shaded(Rgb colour, double shading, double shade, bool diverging)
{
    const double dark = 1 - 0.75 * shading * (1 - shade);
    const double light = diverging ? 0 : std::min(0.5, shading * (shade - 1));
    // Of hills, 52 values of a component are more than eyes tell apart, and a noisy scan's picture takes half the
    // bytes.
    const double step = shading < 1 ? 1 : 5;
    const auto rounded = [step](double c) {
        return static_cast<std::uint8_t>(std::lround(std::round(c / step) * step));
    };
    for (std::uint8_t& c : colour) c = rounded(shade < 1 ? c * dark : std::lerp(double(c), 255, light));
    return colour;
}

void draw_map(Sheet& sheet, const Drawing& d, const Scale& scale, double shading)
{
    const View& view = d.view;
    Eigen::ArrayXXd shade = Eigen::ArrayXXd::Ones(view.rows, view.columns);
    if (shading > 0) shade = hill_shading(d.raster, view.pixel, d.smoothing);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(3 * static_cast<std::size_t>(view.rows) * static_cast<std::size_t>(view.columns));
    for (int row = 0; row < view.rows; ++row)
        for (int column = 0; column < view.columns; ++column) {
            Rgb colour = kBackground;
            if (d.raster.covered(row, column))
                colour = shaded(scale(d.raster.value(row, column)), shading, shade(row, column), scale.diverging);
            pixels.insert(pixels.end(), colour.begin(), colour.end());
        }
    sheet.image(d.layout.drawn_at, {double(d.layout.view.columns), double(d.layout.view.rows)}, view.columns, pixels);
}

} // namespace

void draw_picture(const MeshOrCloud& part, const PictureOptions& options,
                  const std::function<Sheet&(int width, int height)>& make)
{
    Drawing d = std::visit([&](const auto& p) { return draw(p, options); }, part);
    d.values.name = options.field;
    d.values.unit = unit_of(options.field, options.units);
    const auto shown = [&](double otherwise) { return d.raster.value.isFinite().select(d.raster.value, otherwise); };
    d.values.least_shown = shown(std::numeric_limits<double>::infinity()).minCoeff();
    d.values.most_shown = shown(-std::numeric_limits<double>::infinity()).maxCoeff();
    const Scale scale = scale_for(d.values.numbers, options);
    const Layout& layout = d.layout;

    Sheet& sheet = make(static_cast<int>(layout.map_corner.x() + layout.map_size.x() + kLegendWidth),
                        static_cast<int>(layout.map_corner.y() + layout.map_size.y() + kBelowMap));
    sheet.box(layout.map_corner, layout.map_size, kBackground);
    draw_map(sheet, d, scale, shading_of(options));
    if (options.within) draw_outlines(sheet, layout, d.raster, *options.within);
    draw_axes(sheet, layout, options.units);
    draw_legend(sheet, layout, d.values, scale);
    draw_numbers(sheet, layout, d.values, options.within ? "inside B" : "");
    sheet.text(options.title, {kLeft, kTop + 4}, kTitle, Sheet::kInk, Sheet::Align::left, true);
}

std::string picture(const MeshOrCloud& part, const PictureOptions& options)
{
    std::optional<Canvas> canvas;
    draw_picture(part, options, [&](int width, int height) -> Sheet& { return canvas.emplace(width, height); });
    return canvas->png();
}

} // namespace fettle
