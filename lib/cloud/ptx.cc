#include "cloud/ptx.h"

#include "cloud/viewpoint.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace fettle::cloud {
namespace {

constexpr std::size_t kMaxScanSide = 1 << 24; // columns or rows of a scan: a scanner turns in steps above 0.1"
constexpr std::size_t kPlainColumns = 4, kColouredColumns = 7;

// A matrix that is written with six digits is a rotation to this.
constexpr double kRotationTolerance = 1e-3;

std::optional<std::vector<double>> numbers_in(std::string_view line)
{
    std::vector<double> numbers;
    for (const std::string_view word : core::words(line)) {
        const std::optional<double> number = core::parse_number(word);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

/// Points of all scans of a file.
struct Points {
    std::vector<Eigen::Vector3d> xyz;
    std::vector<double> intensities;
    std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colours;
};

class PtxParser : core::FileLines {
  public:
    using core::FileLines::FileLines;

    Cloud parse()
    {
        std::size_t scans = 0, rows = 0;
        Eigen::Isometry3d T_file_scanner = Eigen::Isometry3d::Identity();
        Cloud cloud;
        while (next()) {
            if (core::is_blank_line(line())) continue;
            const std::size_t columns = side(line(), "columns");
            rows = side(next_line(), "rows");
            T_file_scanner = read_pose();
            ++scans;
            read_points(columns * rows, T_file_scanner);
        }
        cloud.xyz.resize(3, static_cast<Eigen::Index>(points_.xyz.size()));
        for (std::size_t i = 0; i < points_.xyz.size(); ++i) cloud.xyz.col(i) = points_.xyz[i];
        if (scans == 1) { // else each point has another viewpoint
            cloud.width = rows;
            set_viewpoint(cloud, T_file_scanner.translation(), Eigen::Quaterniond(T_file_scanner.linear()));
        }
        set_field(cloud, "intensity", Eigen::Map<const Eigen::VectorXd>(points_.intensities.data(), cloud.size()));
        if (!points_.colours.empty() && points_.colours.size() == points_.xyz.size())
            set_colours(cloud, Eigen::Map<const Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic>>(
                                   points_.colours.front().data(), 3, cloud.size()));
        return cloud;
    }

  private:
    std::string_view next_line()
    {
        if (!next()) throw core::InputError(source_, "the scan ends after " + std::to_string(number()) + " lines");
        return line();
    }

    std::size_t side(std::string_view text, const std::string& what)
    {
        const auto words = core::words(text);
        const auto value = words.size() == 1 ? core::parse_integer<std::size_t>(words[0]) : std::nullopt;
        if (!value || *value == 0 || *value > kMaxScanSide)
            refuse("expected the number of " + what + ", got " + core::in_quotes(text));
        return *value;
    }

    std::vector<double> numbers(std::size_t count)
    {
        const auto values = numbers_in(next_line());
        if (!values || values->size() != count)
            refuse("expected " + std::to_string(count) + " numbers, got " + core::in_quotes(line()));
        return *values;
    }

    /// The registered position and axes repeat what the matrix says.
    Eigen::Isometry3d read_pose()
    {
        for (int k = 0; k < 4; ++k) numbers(3);
        Eigen::Matrix4d transposed;
        for (int k = 0; k < 4; ++k) transposed.row(k) = Eigen::Map<const Eigen::RowVector4d>(numbers(4).data());
        const Eigen::Matrix3d R = transposed.topLeftCorner<3, 3>().transpose();
        if (!transposed.allFinite() || !(R * R.transpose()).isIdentity(kRotationTolerance) || R.determinant() < 0)
            refuse("the matrix is no rotation and translation");
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
        pose.translation() = transposed.bottomLeftCorner<1, 3>().transpose();
        return pose;
    }

    void read_points(std::size_t count, const Eigen::Isometry3d& T_file_scanner)
    {
        for (std::size_t i = 0; i < count; ++i) {
            const auto values = numbers_in(next_line());
            if (!values || (values->size() != kPlainColumns && values->size() != kColouredColumns))
                refuse("expected x y z intensity [r g b], got " + core::in_quotes(line()));
            const Eigen::Vector3d p(values->data());
            points_.xyz.push_back(p.isZero(0) ? Eigen::Vector3d(Eigen::Vector3d::Constant(core::kNaN))
                                              : T_file_scanner * p);
            points_.intensities.push_back((*values)[3]);
            if (values->size() == kColouredColumns) points_.colours.push_back(colour(*values));
        }
    }

    Eigen::Matrix<std::uint8_t, 3, 1> colour(const std::vector<double>& values)
    {
        Eigen::Matrix<std::uint8_t, 3, 1> rgb;
        for (int k = 0; k < 3; ++k) {
            const double value = values[kPlainColumns + std::size_t(k)];
            if (!(value >= 0 && value <= 255))
                refuse("a colour is a number from 0 to 255, got " + core::to_short_text(value));
            rgb[k] = static_cast<std::uint8_t>(std::lround(value));
        }
        return rgb;
    }

    Points points_;
};

} // namespace

Cloud parse_ptx(std::string_view bytes, const std::string& source) { return PtxParser(bytes, source).parse(); }

bool looks_like_ptx(std::string_view bytes)
{
    constexpr std::size_t kCounts[] = {1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
    core::Lines lines(bytes);
    return std::ranges::all_of(kCounts, [&](std::size_t count) {
        const auto numbers = lines.next() ? numbers_in(lines.line()) : std::nullopt;
        return numbers && numbers->size() == count;
    });
}

} // namespace fettle::cloud
