#include "downwash/robot_import/xml_element.hpp"

#include <algorithm>
#include <pugixml.hpp>

#include "downwash/base/text.hpp"

namespace downwash::robot_import {
namespace {

/// The place of each byte of a text.
class Lines {
 public:
    explicit Lines(const std::string& text) {
        for (std::size_t at = 0; at < text.size(); ++at) {
            if (text[at] == '\n') {
                begins_.push_back(at + 1);
            }
        }
    }
    [[nodiscard]] Place place(std::ptrdiff_t offset) const {
        const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
        const auto after = std::upper_bound(begins_.begin(), begins_.end(), at);
        return {static_cast<int>(after - begins_.begin()), static_cast<int>(at - *(after - 1)) + 1};
    }

 private:
    std::vector<std::size_t> begins_{0};
};

XmlElement copied(const pugi::xml_node& node, const Lines& lines, int depth, Findings& findings) {
    constexpr int most = 100;
    XmlElement element;
    element.name = node.name();
    // pugixml counts from the name, which stands behind "<".
    element.place = lines.place(node.offset_debug() - 1);
    if (depth > most) {
        findings.fail(element.place, "<" + excerpt(element.name) + "> is nested more than " + std::to_string(most) +
                                         " elements deep: expected a robot");
    }
    element.text = trimmed(node.child_value());
    for (const pugi::xml_attribute& attribute : node.attributes()) {
        element.attributes.emplace_back(attribute.name(), attribute.value());
    }
    for (const pugi::xml_node& child : node.children()) {
        if (child.type() == pugi::node_element) {
            element.children.push_back(copied(child, lines, depth + 1, findings));
        }
    }
    return element;
}

void reject_xacro(const XmlElement& root, Findings& findings) {
    const auto fail = [&](const XmlElement& element, const std::string& what) {
        findings.fail(element.place, what +
                                         " is a macro of xacro that was not expanded: run `xacro FILE > robot.urdf` "
                                         "and import what it writes");
    };
    for_each_element(root, [&](const XmlElement& element) {
        if (element.name.starts_with("xacro:")) {
            fail(element, "<" + excerpt(element.name) + ">");
        }
        for (const auto& [name, value] : element.attributes) {
            if (value.find("${") != std::string::npos || value.find("$(") != std::string::npos) {
                fail(element, name + "=\"" + excerpt(value) + "\" of <" + excerpt(element.name) + ">");
            }
        }
    });
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view wanted) const {
    const auto found = std::ranges::find_if(children, [wanted](const XmlElement& each) { return each.name == wanted; });
    return found == children.end() ? nullptr : &*found;
}

std::vector<const XmlElement*> XmlElement::all(std::string_view wanted) const {
    std::vector<const XmlElement*> found;
    for (const XmlElement& each : children) {
        if (each.name == wanted) {
            found.push_back(&each);
        }
    }
    return found;
}

std::optional<std::string> XmlElement::attribute(std::string_view wanted) const {
    for (const auto& [key, value] : attributes) {
        if (key == wanted) {
            return value;
        }
    }
    return std::nullopt;
}

std::optional<std::string> XmlElement::text_of(std::string_view wanted) const {
    const XmlElement* found = child(wanted);
    return found != nullptr ? std::optional(found->text) : std::nullopt;
}

std::optional<double> number_in(std::string_view text) {
    return parse_number<double>(trimmed(text));
}

XmlElement parse_xml(const std::string& text, Findings& findings) {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
    const Lines lines(text);
    if (!result) {
        findings.fail(lines.place(result.offset), std::string("is not well-formed XML (") + result.description() +
                                                      "): expected a URDF, SDF or MJCF file; check the elements "
                                                      "before this place");
    }
    XmlElement root = copied(document.document_element(), lines, 0, findings);
    reject_xacro(root, findings);
    return root;
}

}  // namespace downwash::robot_import
