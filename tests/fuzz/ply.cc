// PLY in its three encodings: vertices and faces, as a mesh, and as points, which are written as PLY and read the same
// again.

#include "cloud/ply.h"
#include "cloud/cloud_writer.h"
#include "cloud/pcd.h"
#include "mesh_round_trip.h"

using namespace fettle;

namespace {

std::string as_ply(const cloud::Cloud& cloud)
{
    std::ostringstream out;
    cloud::CloudWriter writer(out, cloud::CloudFormat::ply, units::Units{}, static_cast<std::size_t>(cloud.size()));
    writer.write(cloud);
    writer.finish();
    return out.str();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view bytes = fuzz::text_of(data, size);
    fuzz::is_read([&] {
        const cloud::Ply ply = cloud::parse_ply(bytes, "file");
        for (const std::uint32_t corner : ply.corners)
            fuzz::require(corner < static_cast<std::size_t>(ply.vertices.size()), "corners are vertices");
    });
    cloud::Cloud cloud;
    if (cloud::looks_like_ply(bytes) && fuzz::is_read([&] { cloud = cloud::parse_cloud(bytes, "file").cloud; })) {
        const cloud::Cloud again = cloud::parse_cloud(as_ply(cloud), "written").cloud;
        fuzz::require(as_ply(cloud::parse_cloud(as_ply(again), "written").cloud) == as_ply(again),
                      "it reads the same again");
    }
    fuzz::check_mesh(bytes);
    return 0;
}
