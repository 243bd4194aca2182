#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace fettle::core {

/// Attributes of an XML element.
class XmlAttributes {
  public:
    /// @param pairs  name, value, name, value, …, null
    explicit XmlAttributes(const char* const* pairs) : pairs_(pairs) {}

    /// The value of an attribute, unless it is missing. @param name  as written, with its prefix
    std::optional<std::string_view> find(std::string_view name) const;

  private:
    const char* const* pairs_;
};

/// Receives what an XML document holds, in its order. What its functions throw ends the parsing.
class XmlHandler {
  public:
    virtual ~XmlHandler() = default;
    /// @param name  of the element, as written, with its prefix
    virtual void begin(std::string_view name, const XmlAttributes& attributes) = 0;
    virtual void text(std::string_view) {}
    virtual void end(std::string_view name) = 0;
};

/// Parses an XML document piece by piece, by expat. A document type, which could define entities that grow without
/// bound, is refused, and so are elements nested more than 100 deep.
class XmlParser {
  public:
    /// @param source  of the document, for messages; both must outlive the parser
    XmlParser(XmlHandler& handler, const std::string& source);
    ~XmlParser();

    /// @throws InputError with the line, and whatever the handler throws, with the line if it is an InputError
    void feed(std::string_view piece);
    /// Checks that the document is complete. @throws InputError as feed()
    void finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Checks a document before a library gets it that descends into elements without a bound, or is lenient.
/// @throws InputError as XmlParser
void require_plain_xml(std::string_view text, const std::string& source);

} // namespace fettle::core
