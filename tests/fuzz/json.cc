// JSON: by itself, and as the document that its kind names. Surfaces are written and read the same again. Jobs and
// plans have a target of their own.

#include "belt/contact_wheel.h"
#include "gantry/machine.h"
#include "memory_file.h"
#include "part/part.h"
#include "report/summary.h"
#include "robot/robot.h"
#include "same_document.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "json/document.h"
#include "json/leaves.h"

using namespace fettle;

namespace {

void read_kind(const std::string& kind, std::string_view text)
{
    static fuzz::MemoryFile memory;
    if (kind == "surface") {
        const std::string written = surface::to_json(surface::parse_surface(json::Reader::parse(text, "file"))).text();
        fuzz::require(fuzz::is_read([&] {
                          const std::string again =
                              surface::to_json(surface::parse_surface(json::Reader::parse(written, "written"))).text();
                          fuzz::require_same(again, written);
                      }),
                      "a surface that was written is read");
    } else if (kind == "patches") {
        for (const surface::Patch& patch : surface::parse_patches(text, "file")) surface::boundary_polygons(patch);
    } else if (kind == "wheel") {
        belt::read_contact_wheel(memory.with(text));
    } else if (kind == "machine") {
        gantry::read_machine(memory.with(text));
    } else if (kind == "robot") {
        robot::read_robot(memory.with(text));
    } else if (kind == "page") {
        report::read_page_summary(memory.with(text));
    } else if (kind == "frames") {
        report::read_frames(json::Reader::parse(text, "file"), "frames.json"); // there are no pictures beside it
    } else {
        part::read_part(memory.with(text));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    const bool is_json = fuzz::is_read([&] {
        for (const json::Leaf& leaf : json::flatten(text, "file")) json::to_text(leaf);
    });
    std::string kind;
    const bool has_kind = fuzz::is_read([&] {
        kind = json::Reader::parse(text, "file")
                   .choice("kind", {"surface", "patches", "wheel", "machine", "robot", "part", "page", "frames"});
    });
    fuzz::require(is_json || !has_kind, "what has a kind is JSON");
    if (has_kind) fuzz::is_read([&] { read_kind(kind, text); });
    return 0;
}
