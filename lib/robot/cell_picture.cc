#include "robot/cell_picture.h"

#include "core/error.h"
#include "draw/canvas.h"
#include "draw/picture_parts.h"
#include "geometry/bounding_box.h"
#include "robot/cell_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ranges>

namespace fettle::robot {

namespace {

using Align = draw::Sheet::Align;
using Eigen::Vector2d, Eigen::Vector3d;

// Layout of the sheet, pixels.
constexpr double kEdge = 24, kGap = 16, kCaptionHeight = 28, kLegendHeight = 34;
constexpr int kWholeWidth = 700, kCloseUpWidth = 520, kHeight = 520;
// Samples of the scene per pixel in each direction: the mean of nine smooths the edges.
constexpr int kSamplesPerPixel = 3;

// Number of poses before and after the drawn one whose path is drawn: a path over a whole part would hide it.
constexpr Eigen::Index kPathPoses = 400;

constexpr double kFloorSquare = 500;        // mm
constexpr double kCloseUpToolLengths = 1.3; // height of the close-up over the length of the tool
constexpr double kMinToolLength = 60;       // in the close-up, mm
constexpr double kWholeViewMargin = 0.02;   // over the size of the cell

constexpr draw::Rgb kBackground = {246, 247, 249}, kLightFloor = {236, 236, 232}, kDarkFloor = {224, 224, 220};
constexpr draw::Rgb kArm = {232, 140, 60}, kTool = {90, 125, 165}, kFixture = {150, 152, 156}, kPart = {198, 176, 130},
                    kCuboids = {226, 218, 196};
constexpr draw::Rgb kCollides = {200, 30, 40}, kPathColour = {0, 95, 200}, kMark = {20, 20, 20};

draw::Rgb colour_of(const Robot& robot, std::size_t body)
{
    if (body == cuboids_body(robot)) return kCuboids;
    if (body > robot.bodies.size()) return body == floor_body(robot) ? kLightFloor : kDarkFloor;
    if (body == robot.bodies.size()) return kPart;
    const int on = robot.bodies[body].link;
    if (on == link::kTool) return kTool;
    return on == link::kCell || on == link::kTable ? kFixture : kArm;
}

bool collides(const CellClearance& c, const CellPictureOptions& options) { return c.clearance < -options.tolerance; }

// A scene with the colours and the direction of a view.
struct ShadedScene {
    CellScene scene;
    std::vector<draw::Rgb> colours; ///< by triangle, with shading
    Eigen::Matrix3d rotation_view_cell;
};

// Lambertian shading with light from the upper left, and two fifths of it from everywhere.
draw::Rgb shaded(const draw::Rgb& colour, const Vector3d& normal)
{
    static const Vector3d kLight = Vector3d(-1, 1.4, 1.6).normalized();
    constexpr double kAmbient = 0.4;
    const Vector3d facing = normal.z() < 0 ? Vector3d(-normal) : normal;
    const double light = kAmbient + (1 - kAmbient) * std::max(0.0, facing.dot(kLight));
    draw::Rgb result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>(std::lround(colour[k] * light));
    return result;
}

ShadedScene shaded_scene(const Robot& robot, const mesh::Mesh* workpiece, const mesh::Mesh* cuboids,
                         const CellJoints& joints, const Vector3d& from, const std::vector<std::size_t>& colliding)
{
    ShadedScene picture{
        make_cell_scene(robot, workpiece, cuboids, joints, kFloorSquare), {}, draw::view_rotation(from)};
    for (std::size_t i = 0; i < picture.scene.body.size(); ++i) {
        const std::size_t body = picture.scene.body[i];
        const bool collides = std::ranges::find(colliding, body) != colliding.end();
        const draw::Rgb colour = collides ? kCollides : colour_of(robot, body);
        const bool is_floor = body == floor_body(robot) || body == floor_body(robot) + 1;
        const Vector3d normal = picture.rotation_view_cell * picture.scene.normal[i];
        picture.colours.push_back(is_floor ? colour : shaded(colour, normal));
    }
    return picture;
}

// The view of a box in the view's plane that fills a frame of pixels.
draw::View fit_view(const Vector2d& min, const Vector2d& max, int columns, int rows)
{
    draw::View view;
    view.columns = columns;
    view.rows = rows;
    view.pixel = ((max - min).array() / Eigen::Array2d(columns, rows)).maxCoeff();
    view.min_corner = (min + max) / 2 - view.pixel / 2 * Vector2d(columns, rows);
    return view;
}

// Draws a scene in a frame. @return  the depth at each sample, mm
Eigen::ArrayXXd draw_scene(draw::Sheet& sheet, const Vector2d& corner, const ShadedScene& picture,
                           const draw::View& view)
{
    constexpr int n = kSamplesPerPixel;
    const draw::View samples{view.min_corner, view.pixel / n, view.columns * n, view.rows * n};
    Eigen::ArrayXXd depth;
    const Eigen::ArrayXXi visible = visible_triangles(picture.scene, picture.rotation_view_cell, samples, depth);
    std::vector<std::uint8_t> pixels;
    for (int row = 0; row < view.rows; ++row)
        for (int column = 0; column < view.columns; ++column) {
            std::array<int, 3> sum = {0, 0, 0};
            for (int k = 0; k < n * n; ++k) {
                const int triangle = visible(row * n + k / n, column * n + k % n);
                const draw::Rgb& colour = triangle < 0 ? kBackground : picture.colours[triangle];
                for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c];
            }
            for (const int s : sum) pixels.push_back(s / (n * n));
        }
    const Vector2d size(view.columns, view.rows);
    sheet.image(corner, size, view.columns, pixels);
    sheet.line(draw::rectangle_corners(corner, size), draw::kFrameGrey, 1, true);
    return depth;
}

// Draws the visible segments of the path.
// @param tips  3xN, mm, cell frame; NaN where there is no pose
void draw_path(draw::Sheet& sheet, const Vector2d& corner, const ShadedScene& picture, const draw::View& view,
               const Eigen::ArrayXXd& depth, const Eigen::Matrix3Xd& tips)
{
    const double depth_tolerance = 2 * view.pixel; // the path is on the surface that might hide it
    const auto project = [&](Eigen::Index i, Vector2d& pixel) {
        const Vector3d p = picture.rotation_view_cell * tips.col(i);
        pixel = view.to_pixel(p.head<2>());
        const Eigen::Array2d sample = (pixel * kSamplesPerPixel).array().floor();
        const Eigen::Array2d size(depth.cols(), depth.rows());
        if (!((sample >= 0).all() && (sample < size).all())) return false; // also NaN
        const double surface = depth(Eigen::Index(sample.y()), Eigen::Index(sample.x()));
        return std::isnan(surface) || surface <= p.z() + depth_tolerance;
    };
    Vector2d last, here;
    bool last_is_visible = false;
    for (Eigen::Index i = 0; i < tips.cols(); ++i, last = here) {
        const bool is_visible = project(i, here);
        if (is_visible && last_is_visible)
            sheet.line((Eigen::Matrix2d() << corner + last, corner + here).finished(), kPathColour, 1);
        last_is_visible = is_visible;
    }
}

void draw_mark(draw::Sheet& sheet, const Vector2d& at)
{
    constexpr double kRadius = 9;
    Eigen::Matrix2Xd ring(2, 32);
    for (Eigen::Index k = 0; k < ring.cols(); ++k) {
        const double angle = 2 * std::numbers::pi * double(k) / double(ring.cols());
        ring.col(k) = at + kRadius * Vector2d(std::cos(angle), std::sin(angle));
    }
    sheet.line(ring, kMark, 1.6, true);
}

std::string caption(const Robot& robot, const std::vector<CellPair>& pairs, const CellClearance& c,
                    const CellPictureOptions& options)
{
    if (!std::isfinite(c.clearance)) return "clear of everything";
    const std::string who = body_name(robot, pairs[c.pair].a) + " and " + body_name(robot, pairs[c.pair].b);
    const std::string length =
        draw::number_text(std::abs(c.clearance) / options.units.mm()) + " " + units::to_string(options.units.length);
    if (collides(c, options)) return who + " collide by " + length;
    return who + (c.clearance < 0 ? " touch, " : " are nearest, ") + length + (c.clearance < 0 ? " deep" : " apart");
}

double tool_length(const Robot& robot)
{
    double length = kMinToolLength;
    for (const Body& body : robot.bodies)
        if (body.link == link::kTool)
            length = std::max(length, PlacedSolid(body.solid, Eigen::Isometry3d::Identity()).bounding_box().max().z());
    return length;
}

Eigen::Isometry3d tool_in_cell(const Robot& robot, const CellJoints& q)
{
    return base_in_cell(robot, q[6]) * Arm(robot).flange(q.head<6>()) * robot.T_flange_tool;
}

// The tips of the path about a pose, fixed to the part as it stands at that pose. 3xN, mm, cell frame; NaN: no pose
Eigen::Matrix3Xd tips_in_cell(const Robot& robot, const CellJointsPath& joints, Eigen::Index pose)
{
    const Eigen::Index first = std::max<Eigen::Index>(0, pose - kPathPoses);
    Eigen::Matrix3Xd tips(3, std::min(joints.cols(), pose + kPathPoses + 1) - first);
    const Eigen::Isometry3d T_cell_part = part_in_cell(robot, joints(7, pose));
    for (Eigen::Index i = 0; i < tips.cols(); ++i) {
        const CellJoints q = joints.col(first + i);
        tips.col(i).setConstant(NAN);
        if (!q.hasNaN())
            tips.col(i) = T_cell_part * (part_in_cell(robot, q[7]).inverse() * tool_in_cell(robot, q).translation());
    }
    return tips;
}

// An entry of the picture's legend.
struct LegendEntry {
    const char* name;
    draw::Rgb colour;
    bool is_drawn; ///< entries of which nothing is drawn are left out
};

std::vector<LegendEntry> legend_entries(const Robot& robot, const mesh::Mesh* workpiece, const CheckedPath& checked,
                                        const CellPictureOptions& options)
{
    const auto some_body_is = [&](const draw::Rgb& colour) {
        return std::ranges::any_of(std::views::iota(std::size_t{0}, robot.bodies.size()),
                                   [&](std::size_t body) { return colour_of(robot, body) == colour; });
    };
    const auto collides_at = [&](std::size_t pose) { return collides(checked.at_poses[pose], options); };
    return {{"arm", kArm, some_body_is(kArm)},
            {"tool", kTool, some_body_is(kTool)},
            {"fixtures", kFixture, some_body_is(kFixture)},
            {"part", kPart, workpiece != nullptr},
            {"cuboids", kCuboids, options.model != nullptr},
            {"collides", kCollides, std::ranges::any_of(options.poses, collides_at)},
            {"path", kPathColour, true}};
}

void draw_legend(draw::Sheet& sheet, const Vector2d& at, const std::vector<LegendEntry>& entries)
{
    constexpr double kSquare = 14, kSpacing = 96;
    Vector2d place = at;
    for (const LegendEntry& entry : entries) {
        if (!entry.is_drawn) continue;
        sheet.box(place - Vector2d(0, kSquare / 2), {kSquare, kSquare}, entry.colour);
        sheet.text(entry.name, place + Vector2d(kSquare + 6, 0), draw::kSmallCapitals);
        place.x() += kSpacing;
    }
    sheet.text("squares of the floor: 500 mm", place, draw::kSmallCapitals, draw::kTextGrey);
}

draw::View whole_view(const ShadedScene& picture)
{
    const Eigen::Matrix2Xd points = (picture.rotation_view_cell * picture.scene.mesh.vertices).topRows<2>();
    const Eigen::AlignedBox2d box = geometry::bounding_box(points);
    const Vector2d margin = kWholeViewMargin * box.sizes();
    return fit_view(box.min() - margin, box.max() + margin, kWholeWidth, kHeight);
}

draw::View close_up_view(const Robot& robot, const ShadedScene& picture, const CellJoints& q)
{
    const double half = kCloseUpToolLengths * tool_length(robot) / 2;
    const Vector3d middle = tool_in_cell(robot, q) * Vector3d(0, 0, half / 2);
    const Vector2d at = (picture.rotation_view_cell * middle).head<2>();
    return fit_view(at - Vector2d::Constant(half), at + Vector2d::Constant(half), kCloseUpWidth, kHeight);
}

// Draws a row of the sheet: the cell as a whole, and the close-up of the tool.
void draw_pose(draw::Sheet& sheet, const Vector2d& corner, const Robot& robot, const mesh::Mesh* workpiece,
               const CellJointsPath& joints, const CellClearance& c, std::size_t pose,
               const CellPictureOptions& options)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    const CellJoints q = joints.col(pose);
    std::vector<std::size_t> colliding;
    if (collides(c, options)) colliding = {pairs[c.pair].a, pairs[c.pair].b};
    HeterogeneousModel::Geometry parts;
    if (options.model != nullptr)
        parts = options.model->geometry(
            options.model->tool_zone(robot, part_in_cell(robot, q[7]).inverse() * tool_in_cell(robot, q)));
    const mesh::Mesh* const part = options.model == nullptr ? workpiece : &parts.triangles;
    const mesh::Mesh* const cuboids = options.model == nullptr ? nullptr : &parts.cuboids;
    const ShadedScene picture = shaded_scene(robot, part, cuboids, q, options.towards_eye, colliding);
    const Eigen::Matrix3Xd tips = tips_in_cell(robot, joints, pose);
    const std::string title = "Pose " + std::to_string(pose);
    sheet.text(title, corner + Vector2d(0, 12), draw::kLabelCapitals + 1, draw::Sheet::kInk, Align::left, true);
    const Vector2d beside(sheet.text_width(title, draw::kLabelCapitals + 1, true) + 2 * kGap, 12);
    sheet.text(caption(robot, pairs, c, options), corner + beside, draw::kLabelCapitals,
               colliding.empty() ? draw::Sheet::kInk : kCollides);
    for (const bool close_up : {false, true}) {
        const draw::View view = close_up ? close_up_view(robot, picture, q) : whole_view(picture);
        const Vector2d at = corner + Vector2d(close_up ? kWholeWidth + kGap : 0, kCaptionHeight);
        const Eigen::ArrayXXd depth = draw_scene(sheet, at, picture, view);
        draw_path(sheet, at, picture, view, depth, tips);
        if (close_up && std::isfinite(c.clearance)) {
            const Vector2d mark = view.to_pixel((picture.rotation_view_cell * c.point).head<2>());
            if ((mark.array() > 0).all() && mark.x() < kCloseUpWidth && mark.y() < kHeight) draw_mark(sheet, at + mark);
        }
    }
}

} // namespace

std::string draw_cell_picture(const Robot& robot, const mesh::Mesh* workpiece, const CellJointsPath& joints,
                              const CheckedPath& checked, const CellPictureOptions& options)
{
    for (const std::size_t pose : options.poses) {
        const std::size_t count = joints.cols();
        const std::string name = "pose " + std::to_string(pose);
        if (pose >= count) throw core::InputError(name, "the path has only " + std::to_string(count));
        if (joints.col(pose).hasNaN()) throw core::InputError(name, "is not reached");
    }
    const double row = kCaptionHeight + kHeight + kGap;
    draw::Canvas canvas(int(2 * kEdge + kWholeWidth + kGap + kCloseUpWidth),
                        int(kEdge + row * double(options.poses.size()) + kLegendHeight));
    Vector2d corner(kEdge, kEdge);
    for (const std::size_t pose : options.poses) {
        draw_pose(canvas, corner, robot, workpiece, joints, checked.at_poses[pose], pose, options);
        corner.y() += row;
    }
    draw_legend(canvas, corner + Vector2d(0, 4), legend_entries(robot, workpiece, checked, options));
    return canvas.png();
}

} // namespace fettle::robot
