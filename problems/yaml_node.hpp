#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace downwash::problems {

/// A place in a text, both counted from 1; columns count bytes.
struct Mark {
    int line = 1;
    int column = 1;
};

/// One value of a document. Aliases share the node that they stand for, so a tree is never larger than its text.
struct YamlNode {
    enum class Kind { null, scalar, list, map };
    using Pointer = std::shared_ptr<const YamlNode>;

    Kind kind = Kind::null;
    Mark mark;
    std::string text;                                  ///< Text of a scalar.
    bool is_quoted = false;                            ///< a scalar in quotes or a block is text, never a number
    std::vector<Pointer> items;                        ///< Items of a list.
    std::vector<std::pair<Pointer, Pointer>> entries;  ///< Keys and values of a map, duplicates included.
    int depth = 1;                                     ///< levels below and with this one
};

/// The text is no YAML that we accept.
struct YamlError : std::runtime_error {
    YamlError(Mark where, const std::string& message) : std::runtime_error(message), mark(where) {}
    Mark mark;
};

}  // namespace downwash::problems
