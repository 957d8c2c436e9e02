#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/robot_import/findings.hpp"

namespace downwash::robot_import {

/// An element of an XML file, with its place.
struct XmlElement {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::string text;  ///< without the blanks around it
    std::vector<XmlElement> children;
    Place place;

    /// The first child of a name; null if there is none.
    [[nodiscard]] const XmlElement* child(std::string_view wanted) const;
    [[nodiscard]] std::vector<const XmlElement*> all(std::string_view wanted) const;
    /// Empty if there is no such attribute.
    [[nodiscard]] std::optional<std::string> attribute(std::string_view wanted) const;
    /// The text of the first child of a name; empty if there is none.
    [[nodiscard]] std::optional<std::string> text_of(std::string_view wanted) const;
};

/// Calls visit(element) for an element and all below it, in the order of the file.
template <class Visit>
void for_each_element(const XmlElement& element, const Visit& visit) {
    visit(element);
    for (const XmlElement& below : element.children) {
        for_each_element(below, visit);
    }
}

/// The number that a text with blanks around it spells, as formats do without regard to the locale.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

/// Reads XML. @return its root element   @throws ProblemFileError where it is not well-formed, is nested more than a
/// hundred elements deep, or has macros of xacro that were not expanded
[[nodiscard]] XmlElement parse_xml(const std::string& text, Findings& findings);

}  // namespace downwash::robot_import
