#include "compare/comparison.h"

#include "compare/areas.h"
#include "core/constants.h"
#include "geometry/order_statistics.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>

namespace fettle::compare {

namespace {

// Points measured at a time: enough to be close to each other along a Morton curve; they take some 10 MiB.
constexpr std::size_t kBlockPoints = 1 << 16;

struct Block {
    cloud::Cloud cloud;
    ErrorMap map;
    Eigen::VectorXd areas;
    std::vector<job::Region> regions;
};

bool scaled_by_tolerance(const ComparisonOptions& options) { return options.tolerance && *options.tolerance > 0; }

void set_integer_field(cloud::Cloud& cloud, const std::string& name, const Eigen::VectorXi& numbers)
{
    cloud::set_field(cloud, name, Eigen::VectorXd::Zero(numbers.size())); // floats, four bytes each as integers are
    for (cloud::Field& field : cloud.fields)
        if (field.name == name) {
            field.type = 'I';
            std::copy_n(reinterpret_cast<const std::byte*>(numbers.data()), field.bytes.size(), field.bytes.begin());
        }
}

void set_fields(Block& block, const ComparisonOptions& options, const draw::ColourScale& scale)
{
    cloud::Cloud& cloud = block.cloud;
    const ErrorMap& map = block.map;
    cloud::set_normals(cloud, map.normal);
    cloud::set_field(cloud, "error", map.error);
    const std::string axes[] = {"foot_x", "foot_y", "foot_z"};
    for (int axis = 0; axis < 3 && options.with_foot; ++axis) cloud::set_field(cloud, axes[axis], map.foot.row(axis));
    if (options.with_facet && map.facet.size() > 0)
        set_integer_field(cloud, "facet",
                          map.facet.unaryExpr([](double f) { return std::isnan(f) ? -1 : static_cast<int>(f); }));
    if (options.with_region && !block.regions.empty()) {
        Eigen::VectorXi numbers(block.regions.size());
        std::transform(block.regions.begin(), block.regions.end(), numbers.begin(),
                       [](job::Region region) { return static_cast<int>(region); });
        set_integer_field(cloud, "region", numbers);
    }
    if (options.with_sigma && map.reference_sigma.size() > 0) cloud::set_field(cloud, "sigma", map.reference_sigma);
    cloud::set_colours(cloud, draw::colours(scale, map.error));
}

/// Accumulates the statistics of a comparison.
class Accumulator {
  public:
    Accumulator(const ComparisonOptions& options, double limit)
        : all_(options.tolerance, memory_share(options)), histogram_(limit, options.bins),
          sigmas_(memory_share(options) / 8)
    {
        for (const char* name : {"inside", "around", "outside"})
            if (options.job)
                regions_.emplace_back(name, geometry::StatisticsAccumulator(options.tolerance, memory_share(options)));
    }

    void add(const Block& block)
    {
        const Eigen::VectorXd& errors = block.map.error;
        all_.add(errors, block.areas, block.cloud.xyz);
        histogram_.add(errors);
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            std::vector<Eigen::Index> chosen;
            for (std::size_t i = 0; i < block.regions.size(); ++i)
                if (block.regions[i] == static_cast<job::Region>(r)) chosen.push_back(i);
            regions_[r].second.add(errors(chosen), block.areas(chosen), block.cloud.xyz(Eigen::all, chosen));
        }
        std::vector<double> sigmas;
        for (const double s : block.map.reference_sigma)
            if (!std::isnan(s)) sigmas.push_back(s);
        sigmas_.append({reinterpret_cast<const char*>(sigmas.data()), sigmas.size() * sizeof(double)});
        for (const Eigen::Vector3d& point : block.cloud.xyz.colwise())
            if (point.allFinite()) box_.extend(point);
    }

    Comparison comparison() const
    {
        Comparison result{all_.statistics(), {}, histogram_, core::kNaN, box_};
        for (const auto& [name, region] : regions_) result.regions.emplace_back(name, region.statistics());
        if (sigmas_.size() > 0) result.reference_sigma = geometry::median(sigmas_);
        return result;
    }

  private:
    // Bytes for each spool of errors: of all points, and of three regions again. The rest is left for blocks.
    static std::size_t memory_share(const ComparisonOptions& options)
    {
        constexpr std::size_t kReservedBytes = std::size_t{96} << 20;
        return (options.max_memory - std::min(options.max_memory / 2, kReservedBytes)) / (options.job ? 4 : 1);
    }

    geometry::StatisticsAccumulator all_;
    std::vector<std::pair<std::string, geometry::StatisticsAccumulator>> regions_;
    geometry::Histogram histogram_;
    core::Spool sigmas_;
    Eigen::AlignedBox3d box_;
};

/// What is done with each block, which begins at a point.
struct BlockSteps {
    std::function<Block(std::size_t first)> read;
    std::function<void(std::size_t first, Block& block)> measure;
    std::function<void(const Block&block)> accumulate, write;
};

/// Takes the blocks of `count` points through all steps: several are measured at once, and each other step sees them
/// one by one and in order. A cloud without points is one empty block.
void for_each_block(std::size_t count, const BlockSteps& steps)
{
    // While one block is measured, others are read, measured or written.
    constexpr std::size_t kBlocksInFlight = 3;
    std::size_t next = 0;
    bool started = false;
    using Numbered = std::pair<std::size_t, std::shared_ptr<Block>>;
    const auto read = tbb::make_filter<void, Numbered>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& flow) {
        if (started && next >= count) {
            flow.stop();
            return Numbered();
        }
        started = true;
        const std::size_t first = std::exchange(next, next + kBlockPoints);
        return Numbered(first, std::make_shared<Block>(steps.read(first)));
    });
    const auto measure = tbb::make_filter<Numbered, Numbered>(tbb::filter_mode::parallel, [&](const Numbered& in) {
        steps.measure(in.first, *in.second);
        return in;
    });
    const auto accumulate =
        tbb::make_filter<Numbered, Numbered>(tbb::filter_mode::serial_in_order, [&](const Numbered& in) {
            steps.accumulate(*in.second);
            return in;
        });
    const auto write = tbb::make_filter<Numbered, void>(tbb::filter_mode::serial_in_order,
                                                        [&](const Numbered& in) { steps.write(*in.second); });
    tbb::parallel_pipeline(kBlocksInFlight, read & measure & accumulate & write);
}

} // namespace

Survey start_survey(const TestPoints& test, const ComparisonOptions& options)
{
    return Survey(test, options.distance, !scaled_by_tolerance(options));
}

Comparison compare(const TestPoints& test, Survey& survey, const Reference& reference, const ComparisonOptions& options,
                   const std::function<void(const cloud::Cloud&)>& use, const core::Progress& progress)
{
    const std::size_t count = test.points.points;
    const Survey::Results& surveyed = survey.results();
    const draw::ColourScale scale = scaled_by_tolerance(options)
                                        ? draw::colour_scale(Eigen::VectorXd(), *options.tolerance)
                                        : draw::colour_scale(reference(surveyed.sample).error, 0);
    Accumulator accumulator(options, scale.limit);

    const auto read = [&](std::size_t first) {
        Block block;
        block.cloud = test.slice(first, std::min(kBlockPoints, count - first));
        return block;
    };
    const auto measure = [&](std::size_t first, Block& block) {
        block.map = reference(block.cloud.xyz);
        if (options.reversed) block.map.error = (0 - block.map.error.array()).matrix(); // gives no negative zeros
        if (surveyed.plan_areas)
            block.areas = volume_weights((*surveyed.plan_areas)(block.cloud.xyz), block.map, options.distance);
        else
            block.areas = surveyed.vertex_weights.segment(first, block.cloud.size());
        if (options.job) block.regions = job::classify_regions(*options.job, block.cloud.xyz);
        set_fields(block, options, scale);
        block.map.normal.resize(3, 0); // now held as fields of the cloud
        block.map.foot.resize(3, 0);
        block.map.facet.resize(0);
    };
    std::size_t done = 0;
    const auto write = [&](const Block& block) {
        use(block.cloud);
        done += block.cloud.size();
        if (count > 0) core::report_progress(progress, double(done) / count);
    };
    for_each_block(count, {read, measure, [&](const Block& block) { accumulator.add(block); }, write});
    return accumulator.comparison();
}

} // namespace fettle::compare
