#include "machining/stock_frames.h"

#include "draw/figures.h"
#include "draw/picture.h"

namespace fettle::machining {

void add_frames(draw::Frames& frames, removal::HeightField stock, const Cutter& cutter,
                const std::vector<CutterMove>& moves, const Eigen::VectorXd& ends, const MillingOptions& options)
{
    const removal::HeightField before = stock;
    removal::HeightField after = stock;
    mill(after, cutter, moves, options);
    draw::PictureOptions picture;
    constexpr int kWidth = 480; // pixels
    picture.width = kWidth;
    picture.range = {after.z.minCoeff<Eigen::PropagateNumbers>(), before.z.maxCoeff<Eigen::PropagateNumbers>()};
    std::size_t from = 0;
    for (const std::size_t step : frames.steps(std::vector<double>(ends.begin(), ends.end()))) {
        mill(stock, cutter, {moves.begin() + Eigen::Index(from), moves.begin() + Eigen::Index(step) + 1}, options);
        from = step + 1;
        picture.title = draw::duration_text(ends[Eigen::Index(step)]) + ", move " + std::to_string(step + 1) + " of " +
                        std::to_string(moves.size());
        frames.add(ends[Eigen::Index(step)], draw::picture(removal::to_cloud(before, stock), picture));
    }
}

} // namespace fettle::machining
