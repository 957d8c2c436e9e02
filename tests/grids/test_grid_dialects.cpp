// Grids as other programs write and round them.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "../support/csv_dialects.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "grids.hpp"

using namespace downwash;
using test::Random;

namespace {

/// The rows of a grid with their numbers rounded by printf.
std::string rounded(const std::string& text, const char* format) {
    std::size_t at = text.find('\n', text.find("z_m")) + 1;
    std::string all = text.substr(0, at);
    while (at < text.size()) {
        const std::size_t end = text.find_first_of(",\n", at);
        std::array<char, 64> cell{};
        std::snprintf(cell.data(), cell.size(), format, std::stod(text.substr(at, end - at)));
        all += cell.data();
        all += text[end];
        at = end + 1;
    }
    return all;
}

}  // namespace

TEST_CASE("Every dialect, encoding and end of line gives the numbers of the grid") {
    Random random(1);
    const std::vector<test::CsvDialect> dialects = test::csv_dialects();
    CHECK(dialects.size() > 2500);
    for (const test::CsvDialect& dialect : dialects) {
        CAPTURE(dialect.name());
        const int x = random.integer(-900, -100);
        const int step = random.integer(100, 900);
        const int z = random.integer(1, 7000);
        const int z_step = random.integer(100, 900);
        std::vector<double> factors;
        test::CsvRows rows{{"x_m", "z_m", "factor"}};
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i) {
                const int factor = factors.empty() ? 250 : random.integer(1, 3000);
                factors.push_back(factor / 1000.);
                rows.push_back({test::spelled(x + i * step, random), test::spelled(z + k * z_step, random),
                                test::spelled(factor, random)});
            }
        }
        const std::string file = test::csv_file(rows, dialect, random);
        const FactorGrid grid = parse_factor_grid(file, "g.csv");
        REQUIRE(grid.x() == GridAxis{x / 1000., (x + 2 * step) / 1000., 3});
        REQUIRE(grid.z() == GridAxis{z / 1000., (z + 2 * z_step) / 1000., 3});
        REQUIRE(*grid.field("factor") == factors);
    }
}

TEST_CASE("Own grids that were rounded to 5, 6 or 9 digits are read, and cover what they did") {
    Random random(2);
    for (int round = 0; round < 30; ++round) {
        CAPTURE(round);
        FactorGridParts parts;
        const auto axis = [&random](double low_m) {
            const auto count = static_cast<std::size_t>(random.integer(3, 20));
            return GridAxis{low_m, low_m + static_cast<double>(count - 1) * random.uniform(0.05, 0.5), count};
        };
        parts.x = axis(random.uniform(-60, 40));
        parts.z = axis(random.uniform(-1, 12));
        const bool is_volume = round % 3 == 0;
        if (is_volume) {
            parts.y = axis(random.uniform(-20, 20));
        }
        const std::size_t nodes = parts.x.count * parts.z.count * (is_volume ? parts.y.count : 1);
        std::vector<double> factors(nodes);
        std::generate(factors.begin(), factors.end(), [&random] { return random.uniform(0.8, 2); });
        parts.fields = {{"factor", factors}};
        const std::string text = grid_csv_text(FactorGrid(parts));
        for (const char* format : {"%.5g", "%.6g", "%.9g", "%.5f", "%.6f", "%.9f", "%.4e", "%.5e", "%.8e"}) {
            CAPTURE(format);
            const FactorGrid grid = parse_factor_grid(rounded(text, format), "g.csv");
            REQUIRE(grid.x().count == parts.x.count);
            REQUIRE(grid.z().count == parts.z.count);
            const double middle_m = is_volume ? 0.5 * (parts.y.low_m + parts.y.high_m) : 0;
            for (const double x_m : {parts.x.low_m, parts.x.high_m}) {
                for (const double z_m : {parts.z.low_m, parts.z.high_m}) {
                    REQUIRE(grid.contains({x_m, middle_m, z_m}));
                    REQUIRE(grid.factor({x_m, middle_m, z_m}) ==
                            Approx(FactorGrid(parts).factor({x_m, middle_m, z_m})).epsilon(0.02));
                }
            }
            const std::vector<double>& found = *grid.field("factor");
            for (std::size_t i = 0; i < nodes; ++i) {
                REQUIRE(found[i] == Approx(factors[i]).epsilon(6e-5));
            }
        }
    }
}
