#pragma once

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/base64_bytes.hpp"

// The packed parts of a page, read by code of their own.

namespace downwash::test {

inline std::string unpacked(const nlohmann::json& text, std::size_t size) {
    const std::string packed = base64_bytes(text.get<std::string>()).value();
    std::string bytes(size, '\0');
    auto written = static_cast<uLongf>(size);
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &written, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()) == Z_OK);
    REQUIRE(written == size);
    return bytes;
}

/// The columns of a flight, as apps/report/packed_numbers.hpp says.
inline std::vector<std::vector<double>> columns_of(const nlohmann::json& flight) {
    const auto rows = flight["rows"].get<std::size_t>();
    const auto same_as = flight["same_as"].get<std::vector<int>>();
    const auto stored = static_cast<std::size_t>(std::count(same_as.begin(), same_as.end(), -1));
    const std::string bytes = unpacked(flight["data"], stored * rows * 8);
    std::vector<std::vector<double>> columns;
    std::size_t begin = 0;
    for (const int twin : same_as) {
        if (twin >= 0) {
            columns.push_back(columns.at(static_cast<std::size_t>(twin)));
            continue;
        }
        std::vector<double>& column = columns.emplace_back();
        std::uint64_t bits = 0;
        for (std::size_t row = 0; row < rows; ++row) {
            for (std::size_t byte = 0; byte < 8; ++byte) {
                bits ^= std::uint64_t{static_cast<unsigned char>(bytes[begin + byte * rows + row])} << (8 * byte);
            }
            column.push_back(std::bit_cast<double>(bits));
        }
        begin += rows * 8;
    }
    return columns;
}

}  // namespace downwash::test
