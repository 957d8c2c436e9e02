#include "downwash/grids/factor_grid_file.hpp"

#include <charconv>
#include <cstdint>
#include <system_error>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/grid_formats.hpp"

namespace downwash {
namespace {

[[noreturn]] void refuse(const std::string& message) {
    throw InputError(std::vector<KeyError>{{"", message}});
}

/// The ending that says how a grid is written.
std::string checked_kind(const std::filesystem::path& file) {
    std::string kind = file.extension().string();
    if (kind != ".vti" && kind != ".csv") {
        refuse(file.string() + " ends in '" + excerpt(kind) + "': expected .vti (VTK ImageData) or .csv");
    }
    return kind;
}

}  // namespace

std::optional<double> number_of(std::string_view text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [parsed, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && parsed == end ? std::optional(value) : std::nullopt;
}

std::string provenance_line(std::string_view key, std::string_view value) {
    std::string line(key);
    line += value.empty() ? ":" : ": ";
    line += value;
    return line;
}

std::pair<std::string, std::string> provenance_entry(std::string_view line) {
    line = trimmed(line);
    std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos && line.ends_with(':')) {
        colon = line.size() - 1;
    }
    const std::string_view key = colon == std::string_view::npos ? std::string_view() : trimmed(line.substr(0, colon));
    if (key.empty() || key.ends_with(':')) {
        return {"comment", std::string(line)};
    }
    return {std::string(key), std::string(trimmed(line.substr(colon + 1)))};
}

FactorGrid parse_factor_grid(std::string_view bytes, const std::string& name, const GridReading& reading) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    std::string_view content = bytes;
    if (content.starts_with(byte_order_mark)) {
        content.remove_prefix(byte_order_mark.size());
    }
    const bool is_xml = content.substr(0, content.find_first_not_of(" \t\r\n") + 1).ends_with('<');
    return is_xml ? parse_vti(bytes, name, reading) : parse_grid_csv(content, name, reading);
}

FactorGrid read_factor_grid(const std::filesystem::path& file, const GridReading& reading) {
    const auto require_readable = [&file](std::uintmax_t bytes) {
        if (bytes > largest_grid_file) {
            refuse(file.string() + " is larger than 2 GiB: expected a grid of thrust factors");
        }
    };
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    require_readable(unknown ? 0 : size);  // before memory is asked for
    std::string bytes;
    try {
        bytes = read_file(file, largest_grid_file + 1);
    } catch (const FileError& error) {
        refuse(file.string() + " " + error.what());
    }
    require_readable(bytes.size());
    return parse_factor_grid(bytes, file.string(), reading);
}

void require_grid_writable(const std::filesystem::path& file) {
    static_cast<void>(checked_kind(file));
    try {
        require_writable(file);
    } catch (const FileError& error) {
        refuse(file.string() + " " + error.what());
    }
}

void write_factor_grid(const std::filesystem::path& file, const FactorGrid& grid) {
    const std::string kind = checked_kind(file);
    try {
        write_file(file, kind == ".vti" ? vti_text(grid) : grid_csv_text(grid));
    } catch (const FileError& error) {
        refuse(file.string() + " " + error.what());
    }
}

}  // namespace downwash
