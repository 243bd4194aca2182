#include "station/sketch.h"

#include "job/boundary.h"
#include "surface/surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle::station {
namespace {

constexpr double kCharacterAspect = 2;   // height over width
constexpr double kMinSize = 10;          // mm: the sketch of a single point
constexpr double kStepsPerCharacter = 4; // along an edge
constexpr char kCornerMarks[] = "123456789abcdefghijklmnopqrstuvwxyz";

class Canvas {
  public:
    Canvas(const Eigen::AlignedBox2d& box, int columns, int rows)
        : lines_(std::size_t(rows), std::string(std::size_t(columns), ' '))
    {
        const Eigen::Vector2d size = box.sizes().cwiseMax(kMinSize);
        width_ = std::max(size.x() / (columns - 1), size.y() / (rows - 1) / kCharacterAspect);
        const Eigen::Vector2d shown((columns - 1) * width_, (rows - 1) * width_ * kCharacterAspect);
        upper_left_ = box.center() + Eigen::Vector2d(-shown.x(), shown.y()) / 2;
    }

    void mark(const Eigen::Vector2d& at, char sign)
    {
        const auto column = std::lround((at.x() - upper_left_.x()) / width_);
        const auto row = std::lround((upper_left_.y() - at.y()) / (width_ * kCharacterAspect));
        if (row < 0 || row >= long(lines_.size()) || column < 0 || column >= long(lines_[0].size())) return;
        lines_[std::size_t(row)][std::size_t(column)] = sign;
    }

    void draw_outline(const Eigen::Matrix3Xd& polygon, char sign)
    {
        for (Eigen::Index i = 0; i < polygon.cols(); ++i) {
            const Eigen::Vector2d from = polygon.col(i).head<2>();
            const Eigen::Vector2d to = polygon.col((i + 1) % polygon.cols()).head<2>();
            const int steps = 1 + int((to - from).norm() / width_ * kStepsPerCharacter);
            for (int k = 0; k <= steps; ++k) mark(from + (to - from) * (double(k) / steps), sign);
        }
    }

    Eigen::Vector2d place(std::size_t row, std::size_t column) const
    {
        return upper_left_ + width_ * Eigen::Vector2d(double(column), -kCharacterAspect * double(row));
    }
    const std::vector<std::string>& lines() const { return lines_; }

  private:
    std::vector<std::string> lines_; ///< from above
    double width_ = 1;               ///< of a character, mm
    Eigen::Vector2d upper_left_;     ///< middle of the first character
};

Eigen::AlignedBox2d bounds(const SketchContent& content)
{
    Eigen::AlignedBox2d box;
    const Record& record = content.record;
    for (const Eigen::Matrix3Xd* polygon : {&record.job.anomaly, &record.job.sampling})
        for (Eigen::Index i = 0; i < polygon->cols(); ++i) box.extend(Eigen::Vector2d(polygon->col(i).head<2>()));
    for (const auto* points : {&record.anomaly, &record.sampling})
        for (const Eigen::Vector3d& point : *points) box.extend(Eigen::Vector2d(point.head<2>()));
    if (content.tool) box.extend(*content.tool);
    return box;
}

/// One digit for each character inside B.
void draw_sigma(Canvas& canvas, const plan::Plan& plan)
{
    constexpr double kTenths = 10, kMaxDigit = 9;
    const Eigen::Matrix2d R = job::rotation_working_machine(plan.job.theta);
    const job::Polygon anomaly = job::working_boundaries(plan.job).anomaly;
    std::vector<Eigen::Vector2d> places;
    for (std::size_t row = 0; row < canvas.lines().size(); ++row)
        for (std::size_t column = 0; column < canvas.lines()[0].size(); ++column)
            if (const Eigen::Vector2d at = canvas.place(row, column); job::contains(anomaly, R * at))
                places.push_back(at);
    if (places.empty()) return;
    const Eigen::VectorXd sigmas = surface::sigmas(plan.surface, job::columns_to_matrix(places));
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double tenths = kTenths * sigmas[Eigen::Index(i)] / plan.job.tolerance;
        canvas.mark(places[i], std::isnan(tenths) ? '?' : char('0' + int(std::min(tenths, kMaxDigit))));
    }
}

void draw_corners(Canvas& canvas, const std::vector<Eigen::Vector3d>& points)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        canvas.mark(points[i].head<2>(), kCornerMarks[std::min(i, sizeof kCornerMarks - 2)]);
}

} // namespace

std::vector<std::string> sketch(const SketchContent& content, int columns, int rows)
{
    const Record& record = content.record;
    Canvas canvas(bounds(content), columns, rows);
    if (content.plan != nullptr) draw_sigma(canvas, *content.plan);
    canvas.draw_outline(record.job.sampling, '.');
    canvas.draw_outline(record.job.anomaly, '#');
    for (const Eigen::Vector3d& touch : record.touches) canvas.mark(touch.head<2>(), std::isnan(touch.z()) ? 'x' : 'o');
    if (record.stage == Stage::anomaly || record.stage == Stage::sampling) {
        draw_corners(canvas, record.anomaly);
        draw_corners(canvas, record.sampling);
    }
    if (content.tool) canvas.mark(*content.tool, '+');
    std::vector<std::string> lines = canvas.lines();
    for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

} // namespace fettle::station
