#include "cloud/e57.h"

#include "cloud/e57_records.h"
#include "cloud/viewpoint.h"
#include "core/constants.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace fettle::cloud {
namespace {

/// The records of one scan, and what its columns are called.
class Records {
  public:
    Records(const E57Pages& pages, const E57Scan& scan, const std::string& source)
        : scan_(scan), values_(read_e57_records(pages, scan, source)), source_(source)
    {
    }

    const E57Scan& scan() const { return scan_; }
    Eigen::Index size() const { return values_.cols(); }

    std::optional<Eigen::Index> find(std::string_view name) const
    {
        const auto found = std::ranges::find(scan_.columns, name, &E57Column::name);
        if (found == scan_.columns.end()) return std::nullopt;
        return found - scan_.columns.begin();
    }

    /// Three columns as rows; nothing unless all three are there.
    std::optional<Eigen::Matrix3Xd> find_three(const std::array<std::string_view, 3>& names) const
    {
        Eigen::Matrix3Xd three(3, size());
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto index = find(names[static_cast<std::size_t>(k)]);
            if (!index) return std::nullopt;
            three.row(k) = values_.row(*index);
        }
        return three;
    }

    /// Points in the file's frame, m; NaN: invalid.
    Eigen::Matrix3Xd points() const
    {
        Eigen::Matrix3Xd xyz;
        std::string_view flag = "cartesianInvalidState";
        if (const auto cartesian = find_three({"cartesianX", "cartesianY", "cartesianZ"})) {
            xyz = *cartesian;
        } else if (const auto spherical = find_three({"sphericalRange", "sphericalAzimuth", "sphericalElevation"})) {
            flag = "sphericalInvalidState";
            xyz = from_spherical(*spherical);
        } else {
            throw core::InputError(source_, "E57: a scan has neither Cartesian nor spherical coordinates");
        }
        if (const auto invalid = find(flag))
            for (Eigen::Index i = 0; i < size(); ++i)
                if (values_(*invalid, i) != 0) xyz.col(i).setConstant(core::kNaN);
        return scan_.T_file_scanner * xyz;
    }

    /// Values of a column; NaN if the scan has not got it.
    Eigen::VectorXd column(std::string_view name) const
    {
        const auto index = find(name);
        if (!index) return Eigen::VectorXd::Constant(size(), core::kNaN);
        return values_.row(*index);
    }

    Eigen::Matrix3Xd normals() const
    {
        const auto normals = find_three({"nor:normalX", "nor:normalY", "nor:normalZ"});
        if (!normals) return Eigen::Matrix3Xd::Constant(3, size(), core::kNaN);
        return scan_.T_file_scanner.linear() * *normals;
    }

    /// Whole numbers from 0 to 255, by the range that the column states.
    Eigen::RowVectorXd colour(std::string_view name) const
    {
        const Eigen::Index index = *find(name);
        const E57Column& column = scan_.columns[static_cast<std::size_t>(index)];
        const bool is_integer = column.type == E57Column::Type::integer && column.max > column.min;
        const double min = is_integer ? column.min_value() : 0, max = is_integer ? column.max_value() : 255;
        return values_.row(index).unaryExpr([&](double value) {
            const double level = std::round((value - min) * (255 / (max - min)));
            return std::isfinite(level) ? std::clamp(level, 0.0, 255.0) : 0.0;
        });
    }

  private:
    /// Range, azimuth from x to y, and elevation from the plane x y, rad.
    static Eigen::Matrix3Xd from_spherical(const Eigen::Matrix3Xd& spherical)
    {
        Eigen::Matrix3Xd xyz(3, spherical.cols());
        for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
            const double range = spherical(0, i), azimuth = spherical(1, i), elevation = spherical(2, i);
            xyz.col(i) = range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        }
        return xyz;
    }

    const E57Scan& scan_;
    Eigen::MatrixXd values_;
    const std::string& source_;
};

constexpr std::array<std::string_view, 3> kColours = {"colorRed", "colorGreen", "colorBlue"};

/// Adds the fields that any of the scans has; colours only if all have them.
class FieldCollector {
  public:
    explicit FieldCollector(Eigen::Index points) : normals_(3, points), colours_(3, points)
    {
        for (auto& [name, e57_name, values, is_present] : scalars_) values.resize(points);
    }

    void add(const Records& records, Eigen::Index first)
    {
        for (auto& [name, e57_name, values, is_present] : scalars_) {
            values.segment(first, records.size()) = records.column(e57_name);
            is_present = is_present || records.find(e57_name);
        }
        normals_.middleCols(first, records.size()) = records.normals();
        has_normals_ = has_normals_ || records.find("nor:normalX");
        has_colours_ = has_colours_ && records.find_three(kColours);
        for (Eigen::Index k = 0; has_colours_ && k < 3; ++k)
            colours_.row(k).segment(first, records.size()) =
                records.colour(kColours[static_cast<std::size_t>(k)]).cast<std::uint8_t>();
    }

    void set_fields(Cloud& cloud) const
    {
        for (const auto& [name, e57_name, values, is_present] : scalars_)
            if (is_present) set_field(cloud, name, values);
        if (has_normals_) set_normals(cloud, normals_);
        if (has_colours_ && cloud.size() > 0) set_colours(cloud, colours_);
    }

  private:
    struct Scalar {
        std::string name;
        std::string_view e57_name;
        Eigen::VectorXd values;
        bool is_present = false;
    };
    std::array<Scalar, 3> scalars_ = {
        {{"intensity", "intensity", {}}, {"row", "rowIndex", {}}, {"column", "columnIndex", {}}}};
    Eigen::Matrix3Xd normals_;
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours_;
    bool has_normals_ = false, has_colours_ = true;
};

} // namespace

Cloud parse_e57(std::string_view bytes, const std::string& source)
{
    const E57Pages pages(bytes, source);
    const std::vector<E57Scan> scans = parse_e57_scans(pages.xml(), source);
    if (scans.empty()) throw core::InputError(source, "E57 without points");
    std::vector<Records> records; // of the scans that have points: one without says nothing of fields either
    Eigen::Index points = 0;
    for (const E57Scan& scan : scans) {
        Records read(pages, scan, source);
        if (read.size() == 0) continue;
        points += read.size();
        records.push_back(std::move(read));
    }
    Cloud cloud;
    if (records.size() == 1 && records.front().scan().has_pose) {
        const E57Scan& scan = records.front().scan();
        set_viewpoint(cloud, scan.T_file_scanner.translation(), Eigen::Quaterniond(scan.T_file_scanner.linear()));
    }
    cloud.xyz.resize(3, points);
    FieldCollector fields(points);
    Eigen::Index first = 0;
    for (const Records& scan : records) {
        cloud.xyz.middleCols(first, scan.size()) = scan.points();
        fields.add(scan, first);
        first += scan.size();
    }
    fields.set_fields(cloud);
    return cloud;
}

bool looks_like_e57(std::string_view bytes) { return bytes.starts_with("ASTM-E57"); }

} // namespace fettle::cloud
