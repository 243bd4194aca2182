#include "clean/clean.h"

#include "core/constants.h"
#include "core/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <functional>
#include <utility>

namespace fettle::clean {
namespace {

using mesh::CloudMesh;

/// Takes filter after filter to the part that the one before has left.
class Cleaner {
  public:
    explicit Cleaner(CloudMesh part) : result_{std::move(part), {}, 0} {}

    const CloudMesh& part() const { return result_.part; }
    CleanResult result() { return std::move(result_); }

    /// Leaves out points. @param is_left_out  by the point's index
    void filter_points(const std::string& name, const std::function<bool(Eigen::Index)>& is_left_out)
    {
        filter(name, result_.part.points.size(), is_left_out, mesh::select_points);
    }
    void filter_triangles(const std::string& name, const std::function<bool(Eigen::Index)>& is_left_out)
    {
        filter(name, result_.part.triangles.cols(), is_left_out, mesh::select_triangles);
    }

  private:
    using Select = CloudMesh (*)(const CloudMesh&, const std::vector<Eigen::Index>&);

    void filter(const std::string& name, Eigen::Index count, const std::function<bool(Eigen::Index)>& is_left_out,
                Select select)
    {
        std::vector<Eigen::Index> kept;
        kept.reserve(count);
        for (Eigen::Index i = 0; i < count; ++i)
            if (!is_left_out(i)) kept.push_back(i);
        const Eigen::Index removed = count - static_cast<Eigen::Index>(kept.size());
        result_.filters.push_back({name, removed});
        if (removed == 0) return;
        const bool was_mesh = result_.part.is_mesh();
        result_.part = select(result_.part, kept);
        if (was_mesh ? !result_.part.is_mesh() : result_.part.points.size() == 0)
            throw core::InputError("nothing is left: " + in_words());
    }

    /// "5 invalid, 0 duplicates, 95 cropped".
    std::string in_words() const
    {
        std::string words;
        for (const FilterCount& filter : result_.filters) {
            std::string name = filter.name;
            std::ranges::replace(name, '_', ' ');
            words += (words.empty() ? "" : ", ") + std::to_string(filter.removed) + ' ' + name;
        }
        return words;
    }

    CleanResult result_;
};

/// Takes away what was never measured.
void remove_unmeasured(Cleaner& cleaner)
{
    const Eigen::Matrix3Xd& xyz = cleaner.part().points.xyz;
    if (cleaner.part().is_mesh()) { // its reader has dropped what is not finite
        const Eigen::Matrix3Xi unique = mesh::unique_triangles(cleaner.part().triangles);
        Eigen::Index next = 0; // they are in the order of the mesh
        cleaner.filter_triangles("duplicates", [&](Eigen::Index t) {
            if (next < unique.cols() && cleaner.part().triangles.col(t) == unique.col(next)) return ++next, false;
            return true;
        });
        return;
    }
    cleaner.filter_points("invalid", [&](Eigen::Index i) { return !xyz.col(i).allFinite(); });
    const Eigen::Index at_origin = (xyz.array() == 0).colwise().all().count();
    cleaner.filter_points("at_origin",
                          [&](Eigen::Index i) { return at_origin > 1 && (xyz.col(i).array() == 0).all(); });
    const std::vector<char> is_duplicate = find_duplicates(xyz);
    cleaner.filter_points("duplicates", [&](Eigen::Index i) { return is_duplicate[std::size_t(i)] != 0; });
}

void remove_facing_away(Cleaner& cleaner, const Eigen::Vector3d& direction)
{
    const CloudMesh& part = cleaner.part();
    if (part.is_mesh()) {
        const Eigen::Matrix3Xd normals = mesh::triangle_normals({part.points.xyz, part.triangles});
        cleaner.filter_triangles("facing_away", [&](Eigen::Index t) { return !(normals.col(t).dot(direction) > 0); });
    } else {
        if (!cloud::has_normals(part.points)) throw core::InputError("--facing", "the cloud has no normals");
        const Eigen::Matrix3Xd normals = cloud::normals(part.points);
        cleaner.filter_points("facing_away", [&](Eigen::Index i) { return !(normals.col(i).dot(direction) > 0); });
    }
}

// Field by which points know their places while others are taken away; no file's field has a space in its name.
const std::string kPlaceField = "organised place";

/// The cloud as it came with NaN at the places of what was taken away (as PCL's setKeepOrganized).
cloud::Cloud at_their_places(const cloud::Cloud& left, cloud::Cloud all)
{
    all.xyz.setConstant(core::kNaN);
    const Eigen::VectorXd places = cloud::field(left, kPlaceField);
    for (Eigen::Index i = 0; i < left.size(); ++i) all.xyz.col(static_cast<Eigen::Index>(places[i])) = left.xyz.col(i);
    return all;
}

CleanResult clean_organised(CloudMesh part, CleanRequest request)
{
    if (part.is_mesh() || part.points.width == 0)
        throw core::InputError("--keep-organised", "the cloud has no rows and columns");
    request.keeps_organised = false;
    cloud::Cloud all = part.points;
    cloud::set_field(part.points, kPlaceField, Eigen::VectorXd::LinSpaced(all.size(), 0, double(all.size() - 1)));
    CleanResult result = clean_part(std::move(part), request);
    result.part.points = at_their_places(result.part.points, std::move(all));
    return result;
}

} // namespace

CleanResult clean_part(CloudMesh part, const CleanRequest& request)
{
    if (request.keeps_organised) return clean_organised(std::move(part), request);
    if (request.thinning && part.is_mesh())
        throw core::InputError("--thin", "goes with clouds: a mesh's triangles need all of its vertices");
    Cleaner cleaner(std::move(part));
    const Eigen::Matrix3Xd& xyz = cleaner.part().points.xyz;
    remove_unmeasured(cleaner);
    if (request.crop) {
        const bool is_moved = cleaner.part().points.frame == cloud::Frame::job;
        const Region region = is_moved ? in_job_frame(*request.crop) : *request.crop;
        cleaner.filter_points("cropped", [&](Eigen::Index i) { return !contains(region, xyz.col(i)); });
    }
    if (request.facing) remove_facing_away(cleaner, *request.facing);
    if (request.outliers) {
        const std::vector<char> is_outlier =
            core::with_error_prefix("--outliers", [&] { return find_outliers(xyz, *request.outliers); });
        cleaner.filter_points("outliers", [&](Eigen::Index i) { return is_outlier[std::size_t(i)] != 0; });
    }
    if (request.thinning) {
        const std::vector<char> stays = core::with_error_prefix("--thin", [&] { return thin(xyz, *request.thinning); });
        cleaner.filter_points("thinned", [&](Eigen::Index i) { return stays[std::size_t(i)] == 0; });
    }
    CleanResult result = cleaner.result();
    result.points_left = result.part.points.size();
    return result;
}

} // namespace fettle::clean
