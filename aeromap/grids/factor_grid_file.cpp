#include "downwash/grids/factor_grid_file.hpp"

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/provenance_line.hpp"

namespace downwash {
namespace {

/// The ending that says how a grid is written.
std::string checked_kind(const std::filesystem::path& file) {
    std::string kind = file.extension().string();
    if (kind != ".vti" && kind != ".csv") {
        throw_input_error(file.string() + " ends in '" + excerpt(kind) + "': expected .vti (VTK ImageData) or .csv");
    }
    return kind;
}

}  // namespace

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

FactorGrid read_factor_grid(const std::filesystem::path& file, const PlaneOfMotion& plane) {
    return parse_factor_grid(naming(file, [&] { return read_whole_file(file, max_grid_file_bytes); }), file.string(),
                             plane);
}

void require_grid_writable(const std::filesystem::path& file) {
    static_cast<void>(checked_kind(file));
    naming(file, [&] { require_writable(file); });
}

void write_factor_grid(const std::filesystem::path& file, const FactorGrid& grid) {
    const std::string kind = checked_kind(file);
    naming(file, [&] { write_file(file, kind == ".vti" ? vti_text(grid) : grid_csv_text(grid)); });
}

}  // namespace downwash
