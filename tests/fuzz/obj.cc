// OBJ and OFF: each reader with every text, and the one that the content selects.

#include "mesh/obj_off.h"
#include "mesh_round_trip.h"

using namespace fettle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::is_read([&] { mesh::parse_obj(text, "file"); });
    fuzz::is_read([&] { mesh::parse_off(text, "file"); });
    fuzz::check_mesh(text);
    return 0;
}
