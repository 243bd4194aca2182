#include "mesh/raycast.h"

#include "mesh/triangle.h"

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

// Embree keeps the tree of boxes, in float; every triangle whose box may matter is examined here in double. The boxes
// are a little larger than they need be, and radii and distances a little longer, so that no rounding in float hides
// a triangle. Of equally good triangles the one with the lowest index wins: the answer depends on neither the tree nor
// the threads that built it.

namespace fettle {

namespace {

// Float operations on the way to a box test (shift, box corner, origin, direction times distance, their product with
// the reciprocal direction) are fewer than this; each may round by epsilon times the size of the numbers.
constexpr double kRoundings = 16;

struct RayQuery {
    RTCIntersectContext context; // must come first: Embree hands its address back
    const WatertightRay* ray;
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Index triangle = -1;
    double entry = 0;  ///< distance at which Embree's ray begins
    double margin = 0; ///< by which Embree's ray is longer
};

struct PointQuery {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    TrianglePoint nearest;
    Eigen::Index triangle = -1;
    double margin = 0;
};

/// Distance from `origin` to where the ray enters the box; nothing if it misses it.
std::optional<double> entry_distance(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction)
{
    double near = 0;
    double far = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < box.min()[axis] || origin[axis] > box.max()[axis]) return std::nullopt;
            continue;
        }
        const double a = (box.min()[axis] - origin[axis]) / direction[axis];
        const double b = (box.max()[axis] - origin[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    if (near > far) return std::nullopt;
    return near;
}

} // namespace

struct MeshIndex::State {
    explicit State(const Mesh& indexed);
    ~State();

    Triangle triangle(Eigen::Index index) const
    {
        Triangle corners;
        for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
        return corners;
    }

    static void bounds(const RTCBoundsFunctionArguments* arguments);
    static void intersect(const RTCIntersectFunctionNArguments* arguments);
    static bool approach(RTCPointQueryFunctionArguments* arguments);

    const Mesh& mesh;
    Eigen::AlignedBox3d box;                          ///< of the mesh, with the slack
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< Embree's coordinates begin here, where floats are finest
    double slack = 0;                                 ///< of float coordinates within the box
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

MeshIndex::State::State(const Mesh& indexed) : mesh(indexed)
{
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Triangle corners = triangle(t);
        for (int k = 0; k < 3; ++k) box.extend(Eigen::Vector3d(corners.col(k)));
    }
    if (mesh.triangles.cols() == 0) return;
    centre = box.center();
    slack = kRoundings * std::numeric_limits<float>::epsilon() * box.diagonal().norm();
    box.min().array() -= slack;
    box.max().array() += slack;

    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw std::runtime_error("Embree does not start");
    scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.cols()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
        throw std::bad_alloc(); // the only thing that can go wrong here
    }
}

MeshIndex::State::~State()
{
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
}

void MeshIndex::State::bounds(const RTCBoundsFunctionArguments* arguments)
{
    const State& self = *static_cast<const State*>(arguments->geometryUserPtr);
    const Triangle corners = self.triangle(arguments->primID);
    const Eigen::Vector3f least =
        (corners.rowwise().minCoeff() - self.centre).array().cast<float>() - float(self.slack);
    const Eigen::Vector3f most = (corners.rowwise().maxCoeff() - self.centre).array().cast<float>() + float(self.slack);
    *arguments->bounds_o = {least.x(), least.y(), least.z(), 0, most.x(), most.y(), most.z(), 0};
}

void MeshIndex::State::intersect(const RTCIntersectFunctionNArguments* arguments)
{
    if (arguments->valid[0] == 0) return;
    const State& self = *static_cast<const State*>(arguments->geometryUserPtr);
    RayQuery& query = *reinterpret_cast<RayQuery*>(arguments->context);
    const std::optional<double> distance = query.ray->hit(self.triangle(arguments->primID));
    if (!distance) return;
    const auto index = static_cast<Eigen::Index>(arguments->primID);
    if (*distance > query.distance || (*distance == query.distance && index > query.triangle)) return;
    query.distance = *distance;
    query.triangle = index;
    auto* ray = reinterpret_cast<RTCRayHit*>(arguments->rayhit); // one ray at a time
    ray->ray.tfar = std::min(ray->ray.tfar, static_cast<float>(query.distance - query.entry + query.margin));
}

bool MeshIndex::State::approach(RTCPointQueryFunctionArguments* arguments)
{
    auto& [self, query] = *static_cast<std::pair<const State*, PointQuery>*>(arguments->userPtr);
    const auto index = static_cast<Eigen::Index>(arguments->primID);
    const TrianglePoint found = closest_on_triangle(self->triangle(index), query.point);
    const double best = query.nearest.squared_distance;
    if (found.squared_distance > best || (found.squared_distance == best && index > query.triangle)) return false;
    query.nearest = found;
    query.triangle = index;
    const auto radius = static_cast<float>(std::sqrt(found.squared_distance) + query.margin);
    if (radius >= arguments->query->radius) return false;
    arguments->query->radius = radius;
    return true;
}

MeshIndex::MeshIndex(const Mesh& mesh) : state_(std::make_unique<State>(mesh)) {}
MeshIndex::~MeshIndex() = default;

const Mesh& MeshIndex::mesh() const { return state_->mesh; }

std::optional<MeshIndex::Hit> MeshIndex::cast(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& unit_direction) const
{
    const State& s = *state_;
    if (s.scene == nullptr || !origin.allFinite() || !unit_direction.allFinite()) return std::nullopt;
    const std::optional<double> entry = entry_distance(s.box, origin, unit_direction);
    if (!entry) return std::nullopt;
    const WatertightRay exact(origin, unit_direction);
    RayQuery query;
    rtcInitIntersectContext(&query.context);
    query.ray = &exact;
    query.entry = *entry;
    query.margin = s.slack;
    const Eigen::Vector3f start = (origin + *entry * unit_direction - s.centre).cast<float>();
    const Eigen::Vector3f direction = unit_direction.cast<float>();
    RTCRayHit ray = {};
    ray.ray = {start.x(),
               start.y(),
               start.z(),
               0,
               direction.x(),
               direction.y(),
               direction.z(),
               0,
               static_cast<float>(2 * s.box.diagonal().norm()),
               ~0u,
               0,
               0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(s.scene, &query.context, &ray);
    if (query.triangle < 0) return std::nullopt;
    return Hit{query.distance, query.triangle, origin + query.distance * unit_direction};
}

std::optional<MeshIndex::Hit> MeshIndex::highest(double x, double y) const
{
    if (state_->scene == nullptr) return std::nullopt;
    return cast({x, y, state_->box.max().z()}, -Eigen::Vector3d::UnitZ());
}

std::optional<MeshIndex::Closest> MeshIndex::closest(const Eigen::Vector3d& point, double radius) const
{
    const State& s = *state_;
    if (s.scene == nullptr || !point.allFinite() || !(radius >= 0)) return std::nullopt;
    const Eigen::Vector3f place = (point - s.centre).cast<float>();
    std::pair<const State*, PointQuery> query{&s, {}};
    query.second.point = point;
    query.second.nearest.squared_distance = radius * radius;
    query.second.triangle = std::numeric_limits<Eigen::Index>::max(); // at the radius itself any triangle is welcome
    query.second.margin =
        s.slack + kRoundings * std::numeric_limits<float>::epsilon() * (point - s.centre).cwiseAbs().maxCoeff();
    RTCPointQuery sphere = {place.x(), place.y(), place.z(), 0, static_cast<float>(radius + query.second.margin)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(s.scene, &sphere, &context, State::approach, &query);
    if (query.second.triangle == std::numeric_limits<Eigen::Index>::max()) return std::nullopt;
    return Closest{query.second.nearest.point, query.second.triangle, query.second.nearest.barycentric};
}

} // namespace fettle
