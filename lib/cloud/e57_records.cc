#include "cloud/e57_records.h"

#include "cloud/element.h"
#include "core/error.h"
#include "core/text.h"

#include <algorithm>

namespace fettle::cloud {
namespace {

constexpr std::size_t kSectionHeaderBytes = 32, kPacketHeaderBytes = 4, kDataHeaderBytes = 6;
constexpr std::size_t kMaxEndBytes = 8; // writers end a stream with a whole register of up to 64 bits

class RecordReader {
  public:
    RecordReader(const E57Pages& pages, const E57Scan& scan, const std::string& source)
        : pages_(pages), scan_(scan), source_(source), streams_(scan.columns.size())
    {
    }

    /// @throws InputError where no section of points begins
    std::string_view section_header() const
    {
        const std::string_view header = pages_.at(scan_.offset, kSectionHeaderBytes, "points");
        if (header[0] != 1) refuse("no section of points at " + std::to_string(scan_.offset));
        return header;
    }

    Eigen::MatrixXd read()
    {
        collect_streams();
        std::size_t bits = 0;
        for (std::size_t c = 0; c < streams_.size(); ++c) {
            const auto column_bits = static_cast<std::size_t>(scan_.columns[c].bits());
            bits += column_bits;
            // The product of a false count may not wrap.
            if (column_bits > 0 && scan_.records > streams_[c].size() * 8 / column_bits)
                refuse("column " + scan_.columns[c].name + " has " + std::to_string(streams_[c].size()) +
                       " bytes, too few for " + std::to_string(scan_.records) + " records");
        }
        if (bits == 0) refuse("no column holds data");
        Eigen::MatrixXd values(streams_.size(), static_cast<Eigen::Index>(scan_.records));
        for (std::size_t c = 0; c < streams_.size(); ++c) decode(c, values);
        return values;
    }

  private:
    [[noreturn]] void refuse(const std::string& problem) const { throw core::InputError(source_, "E57: " + problem); }

    /// Joins the pieces of each column's stream.
    void collect_streams()
    {
        const std::string_view header = section_header();
        const auto length = load<std::uint64_t>(header.data() + 8), data = load<std::uint64_t>(header.data() + 16);
        const std::string_view section = pages_.at(scan_.offset, length, "section of points");
        std::string_view packets = pages_.from(data, "data packets");
        const char* const end = section.data() + section.size();
        if (packets.data() < section.data() || packets.data() > end)
            refuse("data packets lie outside of their section");
        packets = packets.substr(0, static_cast<std::size_t>(end - packets.data()));
        while (packets.size() >= kPacketHeaderBytes) {
            const std::size_t bytes = std::size_t{load<std::uint16_t>(packets.data() + 2)} + 1;
            if (bytes > packets.size()) refuse("a packet of " + std::to_string(bytes) + " bytes exceeds its section");
            constexpr unsigned char kIndex = 0, kData = 1, kEmpty = 2;
            const auto type = static_cast<unsigned char>(packets[0]);
            if (type == kData)
                add_packet(packets.substr(0, bytes));
            else if (type != kIndex && type != kEmpty)
                refuse("a packet of type " + std::to_string(type));
            packets.remove_prefix(bytes);
        }
    }

    void add_packet(std::string_view packet)
    {
        if (packet.size() < kDataHeaderBytes) refuse("a data packet of " + std::to_string(packet.size()) + " bytes");
        const std::size_t count = load<std::uint16_t>(packet.data() + 4);
        if (count != streams_.size())
            refuse("a data packet of " + std::to_string(count) + " columns, the scan has " +
                   std::to_string(streams_.size()));
        std::size_t begin = kDataHeaderBytes + 2 * count;
        for (std::size_t c = 0; c < count; ++c) {
            if (begin > packet.size()) refuse("the columns of a data packet exceed it");
            const std::size_t bytes = load<std::uint16_t>(packet.data() + kDataHeaderBytes + 2 * c);
            if (bytes > packet.size() - begin) refuse("the columns of a data packet exceed it");
            streams_[c] += packet.substr(begin, bytes);
            begin += bytes;
        }
    }

    void decode(std::size_t index, Eigen::MatrixXd& values)
    {
        const E57Column& column = scan_.columns[index];
        std::string& stream = streams_[index];
        const auto bits = static_cast<std::uint64_t>(column.bits());
        if (const std::size_t needed = (scan_.records * bits + 7) / 8; stream.size() > needed + kMaxEndBytes)
            refuse("column " + column.name + " has " + std::to_string(stream.size() - needed) +
                   " bytes more than its records need");
        stream.append(kMaxEndBytes + 1, '\0'); // what the last value's loads reach
        for (std::uint64_t i = 0; i < scan_.records; ++i) {
            const char* const at = stream.data() + i * bits / 8;
            double& value = values(static_cast<Eigen::Index>(index), static_cast<Eigen::Index>(i));
            if (column.type == E57Column::Type::float32)
                value = load<float>(at);
            else if (column.type == E57Column::Type::float64)
                value = load<double>(at);
            else
                value = scaled(column, raw_bits(at, i * bits % 8, bits), i);
        }
        std::string().swap(stream);
    }

    /// So many bits from bit `shift` of a byte on, the lowest first.
    static std::uint64_t raw_bits(const char* at, std::uint64_t shift, std::uint64_t bits)
    {
        if (bits == 0) return 0;
        std::uint64_t raw = load<std::uint64_t>(at) >> shift;
        if (shift > 0) raw |= std::uint64_t{static_cast<unsigned char>(at[8])} << (64 - shift);
        return bits == 64 ? raw : raw & ((std::uint64_t{1} << bits) - 1);
    }

    double scaled(const E57Column& column, std::uint64_t raw, std::uint64_t record) const
    {
        const std::uint64_t range = static_cast<std::uint64_t>(column.max) - static_cast<std::uint64_t>(column.min);
        if (raw > range)
            refuse("record " + std::to_string(record) + ": " + column.name + " exceeds its maximum " +
                   std::to_string(column.max));
        const auto integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(column.min) + raw);
        return static_cast<double>(integer) * column.scale + column.offset;
    }

    const E57Pages& pages_;
    const E57Scan& scan_;
    const std::string& source_;
    std::vector<std::string> streams_;
};

} // namespace

Eigen::MatrixXd read_e57_records(const E57Pages& pages, const E57Scan& scan, const std::string& source)
{
    RecordReader reader(pages, scan, source);
    if (scan.records > 0) return reader.read();
    if (scan.offset != 0) reader.section_header(); // 0: some writers leave out the section of a scan without points
    return Eigen::MatrixXd(scan.columns.size(), 0);
}

} // namespace fettle::cloud
