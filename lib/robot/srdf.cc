#include "robot/srdf.h"

#include "core/content.h"
#include "core/error.h"
#include "core/file.h"
#include "core/xml.h"

#include <tinyxml.h>

namespace fettle::robot {

void read_srdf(const std::string& path, const std::vector<std::string>& links, Robot& robot)
{
    const std::string text = core::read_file(path, core::kMaxJsonBytes);
    const std::string source = core::display_name(path);
    const bool is_declared_xml = text.starts_with("<?xml");
    if (!is_declared_xml) core::refuse_other_content(text, source, "an SRDF");
    core::require_plain_xml(text, source);
    TiXmlDocument document;
    document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
    if (document.Error())
        throw core::InputError(source, "line " + std::to_string(document.ErrorRow()) + ": " + document.ErrorDesc());
    const TiXmlElement* root = document.RootElement();
    if (root == nullptr || root->ValueStr() != "robot") throw core::InputError(source, "is no SRDF: no <robot>");
    for (const TiXmlElement* pair = root->FirstChildElement("disable_collisions"); pair != nullptr;
         pair = pair->NextSiblingElement("disable_collisions")) {
        const char *first = pair->Attribute("link1"), *second = pair->Attribute("link2");
        if (first == nullptr || second == nullptr)
            throw core::InputError(source, "line " + std::to_string(pair->Row()) +
                                               ": disable_collisions needs link1 and link2");
        for (std::size_t a = 0; a < links.size(); ++a)
            for (std::size_t b = a + 1; b < links.size(); ++b)
                if ((links[a] == first && links[b] == second) || (links[a] == second && links[b] == first))
                    robot.allowed.emplace_back(a, b);
    }
}

} // namespace fettle::robot
