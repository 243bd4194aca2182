#include "core/xml.h"

#include "core/error.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace fettle::core {

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const
{
    for (const char* const* pair = pairs_; *pair != nullptr; pair += 2)
        if (*pair == name) return pair[1];
    return std::nullopt;
}

/// Exceptions do not pass through expat, which is C: they wait here until it has returned.
struct XmlParser::State {
    XmlHandler& handler;
    const std::string& source;
    XML_Parser parser = XML_ParserCreate(nullptr);
    std::exception_ptr thrown;
    int depth = 0;

    State(XmlHandler& handler_, const std::string& source_) : handler(handler_), source(source_)
    {
        XML_SetUserData(parser, this);
        XML_SetElementHandler(parser, on_begin, on_end);
        XML_SetCharacterDataHandler(parser, on_text);
        XML_SetStartDoctypeDeclHandler(parser, on_document_type);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { XML_ParserFree(parser); }

    std::string line() const { return "line " + std::to_string(XML_GetCurrentLineNumber(parser)); }

    template <typename Call>
    static void guarded(void* user, const Call& call)
    {
        State& state = *static_cast<State*>(user);
        if (state.thrown) return;
        try {
            call(state);
        } catch (const std::exception&) {
            state.thrown = std::current_exception();
            XML_StopParser(state.parser, XML_FALSE);
        }
    }

    static void on_begin(void* user, const char* name, const char** attributes)
    {
        constexpr int kMaxDepth = 100; // scans and models need a dozen
        guarded(user, [&](State& state) {
            if (++state.depth > kMaxDepth) throw InputError("XML elements are nested too deep");
            state.handler.begin(name, XmlAttributes(attributes));
        });
    }
    static void on_end(void* user, const char* name)
    {
        guarded(user, [&](State& state) {
            --state.depth;
            state.handler.end(name);
        });
    }
    static void on_text(void* user, const char* text, int length)
    {
        guarded(user, [&](State& state) { state.handler.text({text, static_cast<std::size_t>(length)}); });
    }
    static void on_document_type(void* user, const char*, const char*, const char*, int)
    {
        guarded(user, [](State&) { throw InputError("a document type (<!DOCTYPE) is not read"); });
    }

    void parse(std::string_view piece, bool is_last)
    {
        const XML_Status status =
            XML_Parse(parser, piece.data(), static_cast<int>(piece.size()), is_last ? XML_TRUE : XML_FALSE);
        if (thrown) {
            try {
                std::rethrow_exception(std::exchange(thrown, nullptr));
            } catch (const InputError& error) {
                throw InputError(source, "XML, " + line() + ": " + error.what());
            }
        }
        if (status != XML_STATUS_OK)
            throw InputError(source, "XML, " + line() + ": " + XML_ErrorString(XML_GetErrorCode(parser)));
    }
};

XmlParser::XmlParser(XmlHandler& handler, const std::string& source) : state_(std::make_unique<State>(handler, source))
{
}

XmlParser::~XmlParser() = default;

void XmlParser::feed(std::string_view piece)
{
    constexpr std::size_t kMaxPiece = 1 << 20; // expat counts in int
    for (; !piece.empty(); piece.remove_prefix(std::min(piece.size(), kMaxPiece)))
        state_->parse(piece.substr(0, kMaxPiece), false);
}

void XmlParser::finish() { state_->parse({}, true); }

void require_plain_xml(std::string_view text, const std::string& source)
{
    struct : XmlHandler {
        void begin(std::string_view, const XmlAttributes&) override {}
        void end(std::string_view) override {}
    } nothing;
    XmlParser parser(nothing, source);
    parser.feed(text);
    parser.finish();
}

} // namespace fettle::core
