#pragma once

// Private to grids.

#include <array>
#include <cstddef>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/grids/vtk_data.hpp"

namespace downwash {

/// A file of VTK's XML format: XML, and appended data that need not be XML.
class VtkFile {
 public:
    /// @param bytes that outlive this object
    /// @throws InputError if they are not such a file
    VtkFile(std::string_view bytes, std::string name);

    [[nodiscard]] pugi::xml_node root() const { return root_; }

    /// @throws InputError with the place of a node
    [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;
    /// @throws InputError with the name of the file
    [[noreturn]] void fail_whole(const std::string& message) const;

    /// The arrays below a node by name.
    using Arrays = std::map<std::string_view, pugi::xml_node>;
    [[nodiscard]] Arrays arrays_in(pugi::xml_node parent) const;

    /// The numbers of an array. @throws InputError if their number is not `count`
    [[nodiscard]] std::vector<double> numbers(pugi::xml_node array, std::size_t count) const;

    /// The texts of an array, a megabyte at most.
    [[nodiscard]] std::vector<std::string> texts(pugi::xml_node array) const;

    /// The name of an array for messages.
    [[nodiscard]] static std::string title(pugi::xml_node array);

 private:
    template <class Read>
    auto located(pugi::xml_node array, const Read& read) const;
    void cut_out_data();
    void read_encoding();
    [[nodiscard]] int one_of(const char* attribute, const std::array<std::string_view, 2>& values,
                             const char* otherwise) const;
    [[nodiscard]] bool is_ascii(pugi::xml_node array) const;
    [[nodiscard]] std::string bytes_of(pugi::xml_node array, std::size_t min_bytes, std::size_t max_bytes) const;
    [[nodiscard]] std::string appended_bytes(pugi::xml_node array, std::size_t min_bytes, std::size_t max_bytes) const;
    [[noreturn]] void fail_at(std::ptrdiff_t offset, const std::string& message) const;

    std::string_view bytes_;
    std::string name_;
    std::string xml_;  ///< the parser's own copy, which it changes
    std::string_view data_;
    std::set<std::size_t> offsets_;  ///< of the arrays in the data
    std::size_t cut_begin_ = 0, cut_size_ = 0;
    pugi::xml_document document_;
    pugi::xml_node root_;
    VtkEncoding encoding_;
    bool is_base64_ = true;
};

}  // namespace downwash
