#include "belt/stock_frames.h"

#include "cloud/cloud.h"
#include "draw/picture.h"

#include <algorithm>
#include <cmath>

namespace fettle::belt {

SurfelPictures::SurfelPictures(const Surfels& surfels, const std::optional<ToleranceRange>& range) : range_(range)
{
    constexpr double kMinMeanNormal = 0.3; // less: a closed part, which faces everywhere
    const Eigen::Vector3d mean = surfels.normal.rowwise().mean();
    towards_eye_ = mean.norm() > kMinMeanNormal ? mean.normalized() : Eigen::Vector3d(1, -2, 1.5).normalized();
    constexpr double kMinScale = 1e-6; // mm: of surfels without stock
    scale_ = kMinScale;
    for (const double displacement : surfels.displacement)
        if (std::isfinite(displacement)) scale_ = std::max(scale_, std::abs(displacement));
}

std::string SurfelPictures::picture(const Surfels& surfels, const std::string& title) const
{
    draw::PictureOptions options;
    constexpr int kWidth = 480; // pixels
    options.width = kWidth;
    options.title = title;
    options.towards_eye = towards_eye_;
    cloud::Cloud cloud;
    cloud.xyz = surfels.position;
    cloud::set_normals(cloud, surfels.normal);
    if (range_) {
        set_assessment(cloud, surfels.displacement, *range_);
        options.field = "class";
    } else {
        cloud::set_field(cloud, "error", surfels.displacement);
        options.field = "error";
        options.scale = scale_;
    }
    return draw::picture(cloud, options);
}

} // namespace fettle::belt
