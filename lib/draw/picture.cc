#include "draw/picture.h"

#include "core/error.h"
#include "draw/canvas.h"
#include "draw/picture_parts.h"
#include "draw/png.h"

#include <algorithm>
#include <cmath>

namespace fettle::draw {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// The sheet, in pixels: the map in its frame, the title above it, the legend to the right, a line of numbers below.
constexpr double kHeightToWidth = 680.0 / 900, kMinHeightToWidth = 0.4, kMinHeight = 290; // for the legend
constexpr double kMapLeft = 84, kMapTop = 36, kTitleHeight = 42, kBelowMap = 122, kLegendWidth = 310;
constexpr Rgb kBackground = {228, 228, 232}; // darker than error 0, lighter than undefined

bool from_above(const Eigen::Vector3d& towards_eye) { return towards_eye.head<2>().isZero(0) && towards_eye.z() > 0; }

/// @param visible  3xN, V, points that must be visible   @param spacing  side of their cells, mm; 0 for a mesh
Layout lay_out(const Eigen::Matrix3Xd& visible, double spacing, const std::vector<Outline>& outlines,
               const PictureOptions& options)
{
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : visible.colwise())
        if (p.head<2>().allFinite()) box.extend(p.head<2>());
    if (box.isEmpty())
        throw core::InputError("no point has a finite " +
                               std::string(from_above(options.towards_eye) ? "x and y" : "x, y and z") +
                               ": there is nothing to draw");
    const Eigen::Matrix3d rotation = view_rotation(options.towards_eye);
    for (const Outline& outline : outlines) {
        const Eigen::Matrix3Xd line = in_view(rotation, outline.line);
        for (const Eigen::Vector3d& p : line.colwise()) box.extend(p.head<2>());
    }
    if (!options.extent.isEmpty())
        for (int corner = 0; corner < 8; ++corner)
            box.extend(Vector2d((rotation * options.extent.corner(Eigen::AlignedBox3d::CornerType(corner))).head<2>()));
    box = Eigen::AlignedBox2d(box.min() - Vector2d::Constant(spacing / 2), box.max() + Vector2d::Constant(spacing / 2));
    // A line of points is drawn as a strip.
    constexpr double kMinSideRatio = 1e-3;
    const Vector2d size = box.sizes().cwiseMax(kMinSideRatio * box.sizes().maxCoeff());
    Layout layout;
    layout.rotation_view_machine = rotation;
    layout.view.pixel = std::max(size.x() / options.width, size.y() / (kHeightToWidth * options.width));
    // Rounding removes the error of the division: one side is a whole number of pixels.
    const Eigen::Array2i pixels = (size / layout.view.pixel).array().round().cast<int>().max(1);
    layout.view.columns = pixels.x();
    layout.view.rows = pixels.y();
    layout.view.min_corner = box.min();
    layout.map_corner = {kMapLeft, kMapTop + (options.title.empty() ? 0 : kTitleHeight)};
    layout.map_size = {double(options.width),
                       std::max({kMinHeightToWidth * options.width, kMinHeight, double(pixels.y())})};
    layout.view_corner = (layout.map_corner + (layout.map_size - pixels.matrix().cast<double>()) / 2).array().floor();
    return layout;
}

/// Radius around a point that takes its colour, mm.
double splat_radius(Index points, double spacing, double pixel)
{
    // A cell's corner is 0.71 spacings from its point. Among random points, one percent of the area is farther than 1.1
    // spacings from all of them. Few points are shown as dots.
    constexpr double kRadiusSpacings = 1.1, kMinRadiusPixels = 0.75, kDotRadiusPixels = 7;
    constexpr Index kMaxDots = 100;
    return points < kMaxDots ? kDotRadiusPixels * pixel : std::max(kRadiusSpacings * spacing, kMinRadiusPixels * pixel);
}

/// Values and depths of all pixels, ready to be coloured.
struct Drawing {
    Layout layout;
    View view;        ///< of the raster: that of the layout, or a finer one
    Raster raster;    ///< values in the units of the picture
    double smoothing; ///< of the hill shading, pixels
    PictureValues values;
    PictureScale scale;
    std::vector<Outline> outlines;
};

View finer(const View& view, int times)
{
    return {view.min_corner, view.pixel / times, view.columns * times, view.rows * times};
}

Drawing render(const cloud::Cloud& cloud, const PictureOptions& options)
{
    Drawing d;
    const double spacing = point_spacing(cloud.xyz);
    constexpr double kSinglePointCell = 1; // mm
    const Eigen::Matrix3Xd projected = in_view(view_rotation(options.towards_eye), cloud.xyz);
    const FieldValues values = field_values(cloud, options.field, options.units, options.job, options);
    if (options.job) d.outlines = outlines_on(cloud, *options.job);
    d.layout = lay_out(projected, spacing > 0 ? spacing : kSinglePointCell, d.outlines, options);
    d.view = finer(d.layout.view, options.supersampling);
    const double pixel = d.view.pixel;
    d.raster =
        rasterise(d.view, projected, values.numbers, splat_radius(projected.cols(), spacing, d.layout.view.pixel));
    d.smoothing = std::max(0.7, spacing / pixel / 2); // half a cell removes the steps between cells
    d.values.numbers = numbers_inside(cloud.xyz, values.numbers, options.job);
    d.scale = values.scale;
    return d;
}

Drawing render(const mesh::Mesh& mesh, const PictureOptions& options)
{
    if (options.field != "z") throw core::InputError("a mesh has no field '" + options.field + "', only z");
    Drawing d;
    const Eigen::Matrix3d rotation = view_rotation(options.towards_eye);
    const mesh::Mesh projected = {in_view(rotation, mesh.vertices), mesh.triangles};
    if (options.job) d.outlines = outlines_on(mesh, *options.job);
    d.layout = lay_out(projected.vertices, 0, d.outlines, options);
    d.view = finer(d.layout.view, options.supersampling);
    d.raster = rasterise(d.view, projected, mesh.vertices.row(2).transpose() / options.units.mm());
    d.smoothing = 0.7;
    d.values.counted = "pixels";
    if (!from_above(options.towards_eye)) { // the statistics do not depend on the view direction
        PictureOptions above = options;
        above.towards_eye = Eigen::Vector3d::UnitZ();
        const Drawing seen_from_above = render(mesh, above);
        d.values.numbers = seen_from_above.values.numbers;
        d.scale = seen_from_above.scale;
        return d;
    }
    // The statistics are those of the visible pixels, which weights them by area; vertices would be weighted by the
    // density of the mesh and count underneath, too.
    Eigen::Matrix3Xd points(3, d.raster.covered.count());
    Eigen::VectorXd numbers(points.cols());
    for (Index column = 0, k = 0; column < d.view.columns; ++column)
        for (Index row = 0; row < d.view.rows; ++row)
            if (d.raster.covered(row, column)) {
                points.col(k) << d.view.centre(row, column), d.raster.depth(row, column);
                numbers[k++] = d.raster.value(row, column);
            }
    d.values.numbers = numbers_inside(points, numbers, options.job);
    d.scale = scale_for(options.field, d.values.numbers, options);
    return d;
}

/// Values of a mesh's pixels by a field of its vertices. Classes have nothing between them: a pixel has that of the
/// nearest corner, which is the class with the largest weight.
Eigen::ArrayXXd field_pixels(const View& view, const mesh::Mesh& projected, const FieldValues& field)
{
    const auto weights = [&](const auto& of_vertex) {
        Eigen::VectorXd values(field.numbers.size());
        for (Index i = 0; i < values.size(); ++i) values[i] = of_vertex(field.numbers[i]);
        return rasterise(view, projected, values).value;
    };
    if (field.scale.packed) { // channel by channel
        Eigen::ArrayXXd pixels = Eigen::ArrayXXd::Zero(view.rows, view.columns);
        for (const int shift : {16, 8, 0})
            pixels += (1 << shift) * weights([shift](double c) { return double((long(c) >> shift) & 255); }).round();
        return pixels;
    }
    if (field.scale.classes.empty()) return weights([](double value) { return value; });
    Eigen::ArrayXXd pixels = Eigen::ArrayXXd::Constant(view.rows, view.columns, std::nan("")),
                    largest = Eigen::ArrayXXd::Zero(view.rows, view.columns);
    for (const FieldClass& one : field.scale.classes) {
        const Eigen::ArrayXXd weight = weights([&](double value) { return value == one.value ? 1.0 : 0.0; });
        pixels = (weight > largest).select(one.value, pixels);
        largest = (weight > largest).select(weight, largest);
    }
    return pixels;
}

Drawing render(const mesh::CloudMesh& part, const PictureOptions& options)
{
    if (!part.is_mesh()) return render(part.points, options);
    const mesh::Mesh mesh = {part.points.xyz, part.triangles, part.points.frame};
    if (options.field == "z") return render(mesh, options);
    const FieldValues field = field_values(part.points, options.field, options.units, options.job, options);
    PictureOptions heights = options;
    heights.field = "z";
    Drawing d = render(mesh, heights); // what is seen, and where
    const mesh::Mesh projected = {in_view(view_rotation(options.towards_eye), mesh.vertices), mesh.triangles};
    d.raster.value = field_pixels(d.view, projected, field);
    d.values.counted = "vertices";
    d.values.numbers = numbers_inside(mesh.vertices, field.numbers, options.job);
    d.scale = field.scale;
    return d;
}

/// Strength of the hill shading. It is full for heights from above, as on a map. The colours of other fields are read
/// as numbers, so they are shaded only where nothing else shows the shape of the part.
double shading_strength(const PictureOptions& options)
{
    constexpr double kHeightShading = 0.75,
                     kFieldShading = 0.5; // from the side: surfaces facing away from the light stay visible
    if (from_above(options.towards_eye)) return options.field == "z" ? 1 : 0;
    return options.field == "z" ? kHeightShading : kFieldShading;
}

/// Shadows keep a quarter of the colour, highlights go at most half-way to white, so that the value stays legible.
/// Near-white means error 0, so diverging colours get no highlights.
/// @param shade  of hill_shading()
Rgb shaded(Rgb colour, double shading, double shade, bool diverging)
{
    const double dark = 1 - 0.75 * shading * (1 - shade);
    const double light = diverging ? 0 : std::min(0.5, shading * (shade - 1));
    // With full shading, 52 values of a component are more than an eye distinguishes, and halve the size of a noisy
    // scan's picture.
    const double step = shading < 1 ? 1 : 5;
    const auto rounded = [step](double c) {
        return static_cast<std::uint8_t>(std::lround(std::round(c / step) * step));
    };
    for (std::uint8_t& c : colour) c = rounded(shade < 1 ? c * dark : std::lerp(double(c), 255, light));
    return colour;
}

/// Colours of all pixels, row by row from the top.
std::vector<std::uint8_t> map_pixels(const Drawing& d, double shading)
{
    const View& view = d.view;
    Eigen::ArrayXXd shade = Eigen::ArrayXXd::Ones(view.rows, view.columns);
    const bool keeps_colours = d.scale.diverging || d.scale.packed || !d.scale.classes.empty();
    if (shading > 0) shade = hill_shading(d.raster, view.pixel, d.smoothing);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(std::size_t{3} * view.rows * view.columns);
    for (int row = 0; row < view.rows; ++row)
        for (int column = 0; column < view.columns; ++column) {
            Rgb colour = kBackground;
            if (d.raster.covered(row, column))
                colour = shaded(d.scale(d.raster.value(row, column)), shading, shade(row, column), keeps_colours);
            pixels.insert(pixels.end(), colour.begin(), colour.end());
        }
    return pixels;
}

} // namespace

static void draw_sheet(Drawing d, const PictureOptions& options,
                       const std::function<Sheet&(int width, int height)>& make)
{
    d.values.name = options.field;
    d.values.unit = unit_of_field(options.field, options.units);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto finite_or = [&](double other) { return d.raster.value.isFinite().select(d.raster.value, other); };
    d.values.min_shown = finite_or(kInfinity).minCoeff();
    d.values.max_shown = finite_or(-kInfinity).maxCoeff();
    const PictureScale& scale = d.scale;
    const Layout& layout = d.layout;

    Sheet& sheet = make(static_cast<int>(layout.map_corner.x() + layout.map_size.x() + kLegendWidth),
                        static_cast<int>(layout.map_corner.y() + layout.map_size.y() + kBelowMap));
    sheet.box(layout.map_corner, layout.map_size, kBackground);
    sheet.image(layout.view_corner, {double(layout.view.columns), double(layout.view.rows)}, d.view.columns,
                map_pixels(d, shading_strength(options)));
    draw_outlines(sheet, layout, d.raster, d.outlines);
    draw_axes(sheet, layout, options.units);
    draw_legend(sheet, layout, d.values, scale);
    const bool has_statistics = !scale.packed && scale.classes.empty();
    if (has_statistics) draw_numbers(sheet, layout, d.values, options.job ? "inside B" : "");
    sheet.text(options.title, {kMapLeft, kMapTop + 4}, kTitleCapitals, Sheet::kInk, Sheet::Align::left, true);
}

void draw_picture(const mesh::MeshOrCloud& part, const PictureOptions& options,
                  const std::function<Sheet&(int width, int height)>& make)
{
    draw_sheet(std::visit([&](const auto& p) { return render(p, options); }, part), options, make);
}

std::string picture(const mesh::CloudMesh& part, const PictureOptions& options)
{
    std::optional<Canvas> canvas;
    draw_sheet(render(part, options), options,
               [&](int width, int height) -> Sheet& { return canvas.emplace(width, height); });
    return canvas->png();
}

std::string map_picture(const mesh::MeshOrCloud& part, const PictureOptions& options)
{
    const Drawing d = std::visit([&](const auto& p) { return render(p, options); }, part);
    return encode_png(map_pixels(d, shading_strength(options)), d.view.columns, d.view.rows);
}

PictureScale picture_scale(const mesh::MeshOrCloud& part, const PictureOptions& options)
{
    return std::visit([&](const auto& p) { return render(p, options).scale; }, part);
}

std::string picture(const mesh::MeshOrCloud& part, const PictureOptions& options)
{
    std::optional<Canvas> canvas;
    draw_picture(part, options, [&](int width, int height) -> Sheet& { return canvas.emplace(width, height); });
    return canvas->png();
}

} // namespace fettle::draw
