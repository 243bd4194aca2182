#include "compare/comparison.h"

#include "compare/areas.h"
#include "compare/order_statistics.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace fettle {

namespace {

// Points that are measured at a time. So many along a Hilbert curve are close to each other, and take some 10 MiB.
constexpr std::size_t kBlock = 1 << 16;

struct Block {
    Cloud cloud;
    ErrorMap map;
    Eigen::VectorXd areas;
    std::vector<Region> regions;
};

bool scaled_by_tolerance(const ComparisonOptions& options) { return options.tolerance && *options.tolerance > 0; }

void turn(ErrorMap& map)
{
    map.error = (0 - map.error.array()).matrix(); // no negative zeros
}

void set_whole_numbers(Cloud& cloud, const std::string& name, const Eigen::VectorXi& numbers)
{
    set_field(cloud, name, Eigen::VectorXd::Zero(numbers.size())); // four bytes each
    for (Field& field : cloud.fields)
        if (field.name == name) {
            field.type = 'I';
            std::copy_n(reinterpret_cast<const std::byte*>(numbers.data()), field.bytes.size(), field.bytes.begin());
        }
}

void set_fields(Block& block, const ComparisonOptions& options, const ColourScale& scale)
{
    Cloud& cloud = block.cloud;
    const ErrorMap& map = block.map;
    set_normals(cloud, map.normal);
    set_field(cloud, "error", map.error);
    const std::string axes[] = {"foot_x", "foot_y", "foot_z"};
    for (int axis = 0; axis < 3 && options.foot; ++axis) set_field(cloud, axes[axis], map.foot.row(axis));
    if (options.facet && map.facet.size() > 0)
        set_whole_numbers(cloud, "facet",
                          map.facet.unaryExpr([](double f) { return std::isnan(f) ? -1 : static_cast<int>(f); }));
    if (options.region && !block.regions.empty()) {
        Eigen::VectorXi numbers(static_cast<Eigen::Index>(block.regions.size()));
        std::transform(block.regions.begin(), block.regions.end(), numbers.begin(),
                       [](Region region) { return static_cast<int>(region); });
        set_whole_numbers(cloud, "region", numbers);
    }
    if (options.sigma && map.reference_sigma.size() > 0) set_field(cloud, "sigma", map.reference_sigma);
    set_colours(cloud, colours(scale, map.error));
}

/// The tallies of a comparison.
class Collected {
  public:
    Collected(const ComparisonOptions& options, double limit)
        : all_(options.tolerance, share(options)), histogram_(limit, options.bins), sigma_(share(options) / 8)
    {
        for (const char* name : {"inside", "around", "outside"})
            if (options.job) regions_.emplace_back(name, Tally(options.tolerance, share(options)));
    }

    void add(const Block& block)
    {
        const Eigen::VectorXd& errors = block.map.error;
        all_.add(errors, block.areas, block.cloud.xyz);
        histogram_.add(errors);
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            std::vector<Eigen::Index> chosen;
            for (std::size_t i = 0; i < block.regions.size(); ++i)
                if (block.regions[i] == static_cast<Region>(r)) chosen.push_back(static_cast<Eigen::Index>(i));
            regions_[r].second.add(errors(chosen), block.areas(chosen), block.cloud.xyz(Eigen::all, chosen));
        }
        std::vector<double> sigma;
        for (const double s : block.map.reference_sigma)
            if (!std::isnan(s)) sigma.push_back(s);
        sigma_.append({reinterpret_cast<const char*>(sigma.data()), sigma.size() * sizeof(double)});
        for (const double coordinate : block.cloud.xyz.reshaped())
            if (std::isfinite(coordinate)) largest_ = std::max(largest_, std::abs(coordinate));
    }

    Comparison comparison() const
    {
        Comparison result{all_.statistics(), {}, histogram_, std::numeric_limits<double>::quiet_NaN(), largest_};
        for (const auto& [name, tally] : regions_) result.regions.emplace_back(name, tally.statistics());
        if (sigma_.size() > 0) result.reference_sigma = median(sigma_);
        return result;
    }

  private:
    // What each kind of error may take: all of them, and those of three regions again. The rest is for blocks.
    static std::size_t share(const ComparisonOptions& options)
    {
        constexpr std::size_t kBlocks = std::size_t{96} << 20;
        return (options.memory - std::min(options.memory / 2, kBlocks)) / (options.job ? 4 : 1);
    }

    Tally all_;
    std::vector<std::pair<std::string, Tally>> regions_;
    Histogram histogram_;
    Spool sigma_;
    double largest_ = 0;
};

} // namespace

Survey survey(const TestPoints& test, const ComparisonOptions& options)
{
    return Survey(test, options.distance, !scaled_by_tolerance(options));
}

Comparison compare(const TestPoints& test, Survey& survey, const Reference& reference, const ComparisonOptions& options,
                   const std::function<void(const Cloud&)>& use, const Progress& progress)
{
    const std::size_t count = test.points.points;
    const Survey::Found& found = survey.found();
    const ColourScale scale = scaled_by_tolerance(options) ? colour_scale(Eigen::VectorXd(), *options.tolerance)
                                                           : colour_scale(reference(found.sample).error, 0);
    Collected collected(options, scale.limit);

    const auto read = [&](std::size_t first) {
        Block block;
        block.cloud = test.part(first, std::min(kBlock, count - first));
        return block;
    };
    const auto measure = [&](std::size_t first, Block block) {
        block.map = reference(block.cloud.xyz);
        if (options.reversed) turn(block.map);
        if (found.plan)
            block.areas = volume_areas((*found.plan)(block.cloud.xyz), block.map, options.distance);
        else
            block.areas = found.of_vertices.segment(static_cast<Eigen::Index>(first), block.cloud.size());
        if (options.job) block.regions = regions(*options.job, block.cloud.xyz);
        set_fields(block, options, scale);
        block.map.normal.resize(3, 0); // fields of the cloud now
        block.map.foot.resize(3, 0);
        block.map.facet.resize(0);
        return block;
    };
    // While one block is measured another is read, measured or written.
    constexpr std::size_t kUnderWay = 3;
    std::size_t next = 0, done = 0;
    bool begun = false; // a cloud without points is one empty block
    using Numbered = std::pair<std::size_t, std::shared_ptr<Block>>;
    const auto source =
        tbb::make_filter<void, Numbered>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& flow) {
            if (begun && next >= count) {
                flow.stop();
                return Numbered();
            }
            begun = true;
            const std::size_t first = std::exchange(next, next + kBlock);
            return Numbered(first, std::make_shared<Block>(read(first)));
        });
    const auto work = tbb::make_filter<Numbered, Numbered>(tbb::filter_mode::parallel, [&](const Numbered& in) {
        *in.second = measure(in.first, std::move(*in.second));
        return in;
    });
    const auto tally = tbb::make_filter<Numbered, Numbered>(tbb::filter_mode::serial_in_order, [&](const Numbered& in) {
        collected.add(*in.second);
        return in;
    });
    const auto write = tbb::make_filter<Numbered, void>(tbb::filter_mode::serial_in_order, [&](const Numbered& in) {
        use(in.second->cloud);
        done += static_cast<std::size_t>(in.second->cloud.size());
        if (count > 0) tell(progress, static_cast<double>(done) / static_cast<double>(count));
    });
    tbb::parallel_pipeline(kUnderWay, source & work & tally & write);
    return collected.comparison();
}

} // namespace fettle
