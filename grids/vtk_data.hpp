#pragma once

// Private to grids. The contents of the data arrays of VTK's XML files, see the chapter "VTK XML formats" of the VTK
// User's Guide.

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace downwash {

/// An array cannot be read: what was found and what was expected.
struct VtkDataError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// How a file encodes all its binary arrays.
struct VtkEncoding {
    bool is_big_endian = false;
    std::size_t header_bytes = 4;  ///< of each count before the data, 4 or 8
    bool is_compressed = false;    ///< by zlib, in blocks
};

/// How the numbers of an array are written.
struct VtkNumberType {
    std::string_view name;
    std::size_t bytes;
    double (*read)(const char* bytes, bool is_big_endian);
};

/// "Float64", "Int8", ...; nullptr when there is none of that name.
[[nodiscard]] const VtkNumberType* find_vtk_number_type(std::string_view name);

/// The bytes of an array behind its header, uncompressed.
/// @param data of the array alone; blanks may follow
/// @param min_bytes, max_bytes how many bytes the array may have; nothing is allocated before the header was checked
/// for that
/// @throws VtkDataError if the array has another size, or `data` ends before or after it
[[nodiscard]] std::string vtk_bytes(std::string_view data, bool is_base64, const VtkEncoding& encoding,
                                    std::size_t min_bytes, std::size_t max_bytes);

/// Numbers separated by blanks.
/// @throws VtkDataError if their number is not `count`
[[nodiscard]] std::vector<double> vtk_ascii_numbers(std::string_view text, std::size_t count);

/// @pre bytes.size() is a multiple of type.bytes
[[nodiscard]] std::vector<double> vtk_numbers(std::string_view bytes, const VtkNumberType& type, bool is_big_endian);

}  // namespace downwash
