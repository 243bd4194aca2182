#include "cloud/e57_scans.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "core/xml.h"

#include <bit>
#include <cmath>
#include <optional>

namespace fettle::cloud {
namespace {

constexpr double kUnitTolerance = 1e-3; // of a quaternion that is written with few digits

template <typename Number>
Number parse_as(std::string_view text, const std::string& what)
{
    std::optional<Number> number;
    if constexpr (std::is_same_v<Number, double>)
        number = core::parse_number(text);
    else
        number = core::parse_integer<Number>(text);
    if (!number || !std::isfinite(static_cast<double>(*number)))
        throw core::InputError(what + ": " + core::in_quotes(text) + " is not a number");
    return *number;
}

/// Collects the scans while their XML is read. A place in the document is the names of the elements around it.
class ScanReader : public core::XmlHandler {
  public:
    std::vector<E57Scan> scans;
    bool is_e57 = false;

    void begin(std::string_view name, const core::XmlAttributes& attributes) override
    {
        path_.emplace_back(name);
        text_.clear();
        if (path_.size() == 1) is_e57 = name == "e57Root";
        if (!is_in_scan()) return;
        if (path_.size() == kScanDepth) scan_ = {};
        if (has_place({"points"})) {
            has_points_ = true;
            scan_.offset = number<std::uint64_t>(attributes, "fileOffset").value_or(0);
            scan_.records = number<std::uint64_t>(attributes, "recordCount").value_or(0);
        }
        if (path_.size() == kScanDepth + 3 && path_[kScanDepth] == "points" && path_[kScanDepth + 1] == "prototype")
            scan_.columns.push_back(column(std::string(name), attributes));
    }

    void text(std::string_view text) override
    {
        constexpr std::size_t kMaxNumberBytes = 400; // longer text is no number of a pose
        if (text_.size() < kMaxNumberBytes) text_ += text;
    }

    void end(std::string_view) override
    {
        if (is_in_scan()) {
            if (path_.size() == kScanDepth + 3 && path_[kScanDepth] == "pose") read_pose_component();
            if (path_.size() == kScanDepth) finish_scan();
        }
        path_.pop_back();
        text_.clear();
    }

  private:
    static constexpr std::size_t kScanDepth = 3; // e57Root, data3D, vectorChild

    bool is_in_scan() const { return path_.size() >= kScanDepth && path_[0] == "e57Root" && path_[1] == "data3D"; }

    /// Whether the element is this one of a scan.
    bool has_place(std::initializer_list<std::string_view> names) const
    {
        return path_.size() == kScanDepth + names.size() &&
               std::equal(names.begin(), names.end(), path_.begin() + kScanDepth);
    }

    template <typename Number>
    static std::optional<Number> number(const core::XmlAttributes& attributes, const std::string& name)
    {
        const auto text = attributes.find(name);
        if (!text) return std::nullopt;
        return parse_as<Number>(*text, name);
    }

    static E57Column column(std::string name, const core::XmlAttributes& attributes)
    {
        E57Column column;
        column.name = std::move(name);
        const std::string_view type = attributes.find("type").value_or("");
        if (type == "Float") {
            const std::string_view precision = attributes.find("precision").value_or("double");
            if (precision != "single" && precision != "double")
                throw core::InputError(column.name + ": precision is " + core::in_quotes(precision));
            column.type = precision == "single" ? E57Column::Type::float32 : E57Column::Type::float64;
            return column;
        }
        if (type != "Integer" && type != "ScaledInteger")
            throw core::InputError(column.name + ": a column of type " + core::in_quotes(type) + " is not read");
        column.type = E57Column::Type::integer;
        column.min = number<std::int64_t>(attributes, "minimum").value_or(INT64_MIN);
        column.max = number<std::int64_t>(attributes, "maximum").value_or(INT64_MAX);
        if (column.min > column.max) throw core::InputError(column.name + ": minimum is greater than maximum");
        if (type == "ScaledInteger") {
            column.scale = number<double>(attributes, "scale").value_or(1);
            column.offset = number<double>(attributes, "offset").value_or(0);
        }
        return column;
    }

    void read_pose_component()
    {
        const std::string& part = path_[kScanDepth + 1];
        const std::string& axis = path_[kScanDepth + 2];
        scan_.has_pose = true;
        const std::string word = text_.substr(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
        const double value =
            word.empty() ? 0
                         : parse_as<double>(word.substr(0, word.find_last_not_of(" \t\r\n") + 1), part + ' ' + axis);
        const std::size_t index = axis.size() == 1 ? std::string_view("xyzw").find(axis) : std::string_view::npos;
        if (part == "translation" && index < 3) translation_[static_cast<Eigen::Index>(index)] = value;
        if (part == "rotation" && index < 4) {
            if (!rotation_) rotation_ = Eigen::Vector4d::Zero();
            (*rotation_)[static_cast<Eigen::Index>(index)] = value;
        }
    }

    void finish_scan()
    {
        if (rotation_) {
            if (!(std::abs(rotation_->norm() - 1) < kUnitTolerance))
                throw core::InputError("the rotation of a pose is no unit quaternion");
            scan_.T_file_scanner.linear() =
                Eigen::Quaterniond(rotation_->normalized()).toRotationMatrix(); // coefficients x y z w
        }
        scan_.T_file_scanner.translation() = translation_;
        if (has_points_) scans.push_back(std::move(scan_));
        rotation_.reset();
        translation_.setZero();
        has_points_ = false;
    }

    std::vector<std::string> path_;
    std::string text_;
    E57Scan scan_;
    std::optional<Eigen::Vector4d> rotation_; // x y z w
    Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
    bool has_points_ = false;
};

} // namespace

int E57Column::bits() const
{
    if (type == Type::float32) return 32;
    if (type == Type::float64) return 64;
    return std::bit_width(static_cast<std::uint64_t>(max) - static_cast<std::uint64_t>(min));
}

std::vector<E57Scan> parse_e57_scans(std::string_view xml, const std::string& source)
{
    ScanReader reader;
    core::XmlParser parser(reader, source);
    parser.feed(xml);
    parser.finish();
    if (!reader.is_e57) throw core::InputError(source, "E57: its XML has no e57Root");
    return std::move(reader.scans);
}

} // namespace fettle::cloud
