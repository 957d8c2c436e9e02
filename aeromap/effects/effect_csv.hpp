#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/files.hpp"

namespace downwash {

/// Limits of tables and measurements of effects.
inline constexpr CsvReader::Limits effect_csv_limits{100'000, 32};

/// The bytes of such a file. @throws InputError if it cannot be read or has more than 16 MiB
[[nodiscard]] inline std::string read_effect_csv(const std::filesystem::path& file) {
    constexpr std::size_t max_bytes = std::size_t{16} << 20U;
    return naming(file, [&] { return read_whole_file(file, max_bytes); });
}

}  // namespace downwash
