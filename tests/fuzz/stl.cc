// STL, binary and ASCII, at once and piece by piece.

#include "mesh/stl.h"
#include "mesh_round_trip.h"

#include <cstring>

using namespace fettle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view bytes = fuzz::text_of(data, size);
    mesh::MeshRepair repair;
    mesh::Mesh whole, pieces;
    const bool is_whole = fuzz::is_read([&] { whole = mesh::parse_stl(bytes, "file", repair); });
    if (mesh::is_binary_stl(bytes)) {
        const auto read = [&](std::size_t offset, char* to, std::size_t count) {
            fuzz::require(offset + count <= bytes.size(), "only what is there is read");
            std::memcpy(to, bytes.data() + offset, count);
        };
        const bool is_pieces = fuzz::is_read(
            [&] { pieces = mesh::read_binary_stl(bytes.substr(0, mesh::kStlHeaderBytes), read, "file", repair); });
        fuzz::require(is_whole == is_pieces && whole.vertices == pieces.vertices && whole.triangles == pieces.triangles,
                      "pieces are what the whole is");
    }
    fuzz::check_mesh(bytes);
    return 0;
}
