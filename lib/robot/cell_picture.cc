#include "robot/cell_picture.h"

#include "compare/canvas.h"
#include "compare/picture_parts.h"
#include "core/error.h"
#include "robot/cell_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fettle {

namespace {

using Align = Sheet::Align;
using Eigen::Vector2d, Eigen::Vector3d;

// The sheet, pixels.
constexpr double kEdge = 24, kGap = 16, kBelowCaption = 28, kKey = 34;
constexpr int kWhole = 700, kNear = 520, kHeight = 520;
// Points of the scene to a pixel, each way: the mean of nine has smooth edges.
constexpr int kFine = 3;

// So many poses before and behind are drawn as path: all of those that cover a part would hide it.
constexpr Eigen::Index kPathAround = 400;

constexpr double kFloor = 500;      // mm
constexpr double kAroundTool = 1.3; // of the tool's length, the picture beside reaches from the tip's height
constexpr double kLeastAround = 60; // mm
constexpr double kMargin = 0.02;    // of the whole cell, about it

constexpr Rgb kSky = {246, 247, 249}, kLightFloor = {236, 236, 232}, kDarkFloor = {224, 224, 220};
constexpr Rgb kArm = {232, 140, 60}, kTool = {90, 125, 165}, kFixture = {150, 152, 156}, kPart = {198, 176, 130},
              kCuboids = {226, 218, 196};
constexpr Rgb kCollides = {200, 30, 40}, kPathColour = {0, 95, 200}, kMark = {20, 20, 20};

Rgb colour_of(const Robot& robot, std::size_t body)
{
    if (body == cuboids_body(robot)) return kCuboids;
    if (body > robot.bodies.size()) return body == floor_body(robot) ? kLightFloor : kDarkFloor;
    if (body == robot.bodies.size()) return kPart;
    const int on = robot.bodies[body].link;
    if (on == link::kTool) return kTool;
    return on == link::kCell || on == link::kTable ? kFixture : kArm;
}

// A scene as it is looked at, with what stands out in it.
struct Shot {
    CellScene scene;
    std::vector<Rgb> colours; ///< of the triangles, shaded
    Eigen::Matrix3d rotation_view_cell;
};

// Light from the upper left; what lies in its shade keeps two fifths.
Rgb shaded(const Rgb& colour, const Vector3d& normal)
{
    static const Vector3d kLight = Vector3d(-1, 1.4, 1.6).normalized();
    constexpr double kShade = 0.4;
    const Vector3d facing = normal.z() < 0 ? Vector3d(-normal) : normal;
    const double light = kShade + (1 - kShade) * std::max(0.0, facing.dot(kLight));
    Rgb result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>(std::lround(colour[k] * light));
    return result;
}

Shot take_shot(const Robot& robot, const Mesh* workpiece, const Mesh* cuboids, const CellJoints& joints,
               const Vector3d& from, const std::vector<std::size_t>& colliding)
{
    Shot shot{cell_scene(robot, workpiece, cuboids, joints, kFloor), {}, view_rotation(from)};
    for (std::size_t i = 0; i < shot.scene.body.size(); ++i) {
        const std::size_t body = shot.scene.body[i];
        const bool red = std::find(colliding.begin(), colliding.end(), body) != colliding.end();
        const Rgb colour = red ? kCollides : colour_of(robot, body);
        // The floor is paper.
        const bool floor = body == floor_body(robot) || body == floor_body(robot) + 1;
        const Vector3d normal = shot.rotation_view_cell * shot.scene.normal[i];
        shot.colours.push_back(floor ? colour : shaded(colour, normal));
    }
    return shot;
}

// A view of a box in the view's plane that fills a frame of pixels.
View view_of(const Vector2d& least, const Vector2d& most, int columns, int rows)
{
    View view;
    view.columns = columns;
    view.rows = rows;
    view.pixel = ((most - least).array() / Eigen::Array2d(columns, rows)).maxCoeff();
    view.least = (least + most) / 2 - view.pixel / 2 * Vector2d(columns, rows);
    return view;
}

// Draws a shot in a frame. @return  depths of its fine pixels
Eigen::ArrayXXd draw_shot(Sheet& sheet, const Vector2d& corner, const Shot& shot, const View& view)
{
    const View fine{view.least, view.pixel / kFine, view.columns * kFine, view.rows * kFine};
    Eigen::ArrayXXd depth;
    const Eigen::ArrayXXi seen = seen_triangles(shot.scene, shot.rotation_view_cell, fine, depth);
    std::vector<std::uint8_t> pixels;
    for (int row = 0; row < view.rows; ++row)
        for (int column = 0; column < view.columns; ++column) {
            std::array<int, 3> sum = {0, 0, 0};
            for (int k = 0; k < kFine * kFine; ++k) {
                const int triangle = seen(row * kFine + k / kFine, column * kFine + k % kFine);
                const Rgb& colour = triangle < 0 ? kSky : shot.colours[static_cast<std::size_t>(triangle)];
                for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c];
            }
            for (const int s : sum) pixels.push_back(static_cast<std::uint8_t>(s / (kFine * kFine)));
        }
    const Vector2d size(view.columns, view.rows);
    sheet.image(corner, size, view.columns, pixels);
    sheet.line(frame_of(corner, size), kFrame, 1, true);
    return depth;
}

// The path where nothing hides it, as it lies on the part at one pose.
void draw_path(Sheet& sheet, const Vector2d& corner, const Shot& shot, const View& view, const Eigen::ArrayXXd& depth,
               const Eigen::Matrix3Xd& tips)
{
    const double slack = 2 * view.pixel; // it lies on what it might be hidden by
    const auto place = [&](Eigen::Index i, Vector2d& at) {
        const Vector3d p = shot.rotation_view_cell * tips.col(i);
        at = view.to_pixel(p.head<2>());
        const Eigen::Array2d cell = (at * kFine).array().floor(); // NaN: nowhere
        if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() < double(depth.cols()) && cell.y() < double(depth.rows())))
            return false;
        const Eigen::Array2i fine = cell.cast<int>();
        const double hides = depth(fine.y(), fine.x());
        return std::isnan(hides) || hides <= p.z() + slack;
    };
    Vector2d last, here;
    bool before = false;
    for (Eigen::Index i = 0; i < tips.cols(); ++i, last = here) {
        const bool seen = place(i, here);
        if (seen && before) sheet.line((Eigen::Matrix2d() << corner + last, corner + here).finished(), kPathColour, 1);
        before = seen;
    }
}

void draw_mark(Sheet& sheet, const Vector2d& at)
{
    constexpr double kRadius = 9;
    Eigen::Matrix2Xd ring(2, 32);
    for (Eigen::Index k = 0; k < ring.cols(); ++k) {
        const double angle = 2 * std::numbers::pi * double(k) / double(ring.cols());
        ring.col(k) = at + kRadius * Vector2d(std::cos(angle), std::sin(angle));
    }
    sheet.line(ring, kMark, 1.6, true);
}

std::string caption(const Robot& robot, const std::vector<CellPair>& pairs, const CellClearance& c, double tolerance,
                    const Units& units)
{
    if (!std::isfinite(c.clearance)) return "clear of everything";
    const std::string who = body_name(robot, pairs[c.pair].a) + " and " + body_name(robot, pairs[c.pair].b);
    const std::string length = number_text(std::abs(c.clearance) / units.mm()) + " " + to_string(units.length);
    if (c.clearance < -tolerance) return who + " collide by " + length;
    return who + (c.clearance < 0 ? " touch, " : " are nearest, ") + length + (c.clearance < 0 ? " deep" : " apart");
}

double tool_length(const Robot& robot)
{
    double length = kLeastAround;
    for (const Body& body : robot.bodies)
        if (body.link == link::kTool)
            length = std::max(length, PlacedSolid(body.solid, Eigen::Isometry3d::Identity()).box().max().z());
    return length;
}

Eigen::Isometry3d tool_in_cell(const Robot& robot, const CellJoints& q)
{
    return cell_base(robot, q[6]) * Arm(robot).flange(q.head<6>()) * robot.T_flange_tool;
}

// Places in the part where the tips are about a pose, as they lie in the cell at that pose.
Eigen::Matrix3Xd tips_in_cell(const Robot& robot, const CellJointsPath& joints, Eigen::Index pose)
{
    const Eigen::Index first = std::max<Eigen::Index>(0, pose - kPathAround);
    Eigen::Matrix3Xd tips(3, std::min(joints.cols(), pose + kPathAround + 1) - first);
    const Eigen::Isometry3d T_cell_part = cell_part(robot, joints(7, pose));
    for (Eigen::Index i = 0; i < tips.cols(); ++i) {
        const CellJoints q = joints.col(first + i);
        tips.col(i).setConstant(NAN);
        if (!q.hasNaN())
            tips.col(i) = T_cell_part * (cell_part(robot, q[7]).inverse() * tool_in_cell(robot, q).translation());
    }
    return tips;
}

void draw_key(Sheet& sheet, const Vector2d& at)
{
    constexpr double kSample = 14, kStep = 96;
    const std::array<std::pair<const char*, Rgb>, 7> entries = {{{"arm", kArm},
                                                                 {"tool", kTool},
                                                                 {"fixtures", kFixture},
                                                                 {"part", kPart},
                                                                 {"cuboids", kCuboids},
                                                                 {"collides", kCollides},
                                                                 {"path", kPathColour}}};
    Vector2d place = at;
    for (const auto& [name, colour] : entries) {
        sheet.box(place - Vector2d(0, kSample / 2), {kSample, kSample}, colour);
        sheet.text(name, place + Vector2d(kSample + 6, 0), kSmall);
        place.x() += kStep;
    }
    sheet.text("squares of the floor: 500 mm", place, kSmall, kGrey);
}

View whole_view(const Shot& shot)
{
    const Eigen::Matrix2Xd seen = (shot.rotation_view_cell * shot.scene.mesh.vertices).topRows<2>();
    const Vector2d least = seen.rowwise().minCoeff(), most = seen.rowwise().maxCoeff();
    return view_of(least - kMargin * (most - least), most + kMargin * (most - least), kWhole, kHeight);
}

View near_view(const Robot& robot, const Shot& shot, const CellJoints& q)
{
    const double around = kAroundTool * tool_length(robot) / 2;
    const Vector3d middle = tool_in_cell(robot, q) * Vector3d(0, 0, around / 2);
    const Vector2d at = (shot.rotation_view_cell * middle).head<2>();
    return view_of(at - Vector2d::Constant(around), at + Vector2d::Constant(around), kNear, kHeight);
}

// A row of the sheet.
void draw_pose(Sheet& sheet, const Vector2d& corner, const Robot& robot, const Mesh* workpiece,
               const CellJointsPath& joints, const CellClearance& c, std::size_t pose,
               const CellPictureOptions& options)
{
    const std::vector<CellPair> pairs = checked_pairs(robot);
    const CellJoints q = joints.col(static_cast<Eigen::Index>(pose));
    const bool collides = c.clearance < -options.tolerance;
    std::vector<std::size_t> red;
    if (collides) red = {pairs[c.pair].a, pairs[c.pair].b};
    Heterogeneous::Parts parts;
    if (options.model != nullptr)
        parts =
            options.model->parts(options.model->zone(robot, cell_part(robot, q[7]).inverse() * tool_in_cell(robot, q)));
    const Shot shot = options.model == nullptr
                          ? take_shot(robot, workpiece, nullptr, q, options.from, red)
                          : take_shot(robot, &parts.triangles, &parts.cuboids, q, options.from, red);
    const Eigen::Matrix3Xd tips = tips_in_cell(robot, joints, static_cast<Eigen::Index>(pose));
    const std::string title = "Pose " + std::to_string(pose);
    sheet.text(title, corner + Vector2d(0, 12), kLabel + 1, Sheet::kInk, Align::left, true);
    const Vector2d beside(sheet.text_width(title, kLabel + 1, true) + 2 * kGap, 12);
    sheet.text(caption(robot, pairs, c, options.tolerance, options.units), corner + beside, kLabel,
               collides ? kCollides : Sheet::kInk);
    for (const bool close : {false, true}) {
        const View view = close ? near_view(robot, shot, q) : whole_view(shot);
        const Vector2d at = corner + Vector2d(close ? kWhole + kGap : 0, kBelowCaption);
        const Eigen::ArrayXXd depth = draw_shot(sheet, at, shot, view);
        draw_path(sheet, at, shot, view, depth, tips);
        if (close && std::isfinite(c.clearance)) {
            const Vector2d mark = view.to_pixel((shot.rotation_view_cell * c.point).head<2>());
            if ((mark.array() > 0).all() && mark.x() < kNear && mark.y() < kHeight) draw_mark(sheet, at + mark);
        }
    }
}

} // namespace

std::string cell_picture(const Robot& robot, const Mesh* workpiece, const CellJointsPath& joints,
                         const CheckedPath& checked, const CellPictureOptions& options)
{
    for (const std::size_t pose : options.at) {
        const auto count = static_cast<std::size_t>(joints.cols());
        const std::string which = "pose " + std::to_string(pose);
        if (pose >= count) throw InputError(which, "the path has only " + std::to_string(count));
        if (joints.col(static_cast<Eigen::Index>(pose)).hasNaN()) throw InputError(which, "is not reached");
    }
    const double row = kBelowCaption + kHeight + kGap;
    Canvas canvas(static_cast<int>(2 * kEdge + kWhole + kGap + kNear),
                  static_cast<int>(kEdge + row * double(options.at.size()) + kKey));
    Vector2d corner(kEdge, kEdge);
    for (const std::size_t pose : options.at) {
        draw_pose(canvas, corner, robot, workpiece, joints, checked.pose[pose], pose, options);
        corner.y() += row;
    }
    draw_key(canvas, corner + Vector2d(0, 4));
    return canvas.png();
}

} // namespace fettle
