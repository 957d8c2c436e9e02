// Tables of K and measurements as spreadsheets, test stands and scripts write them.

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "../support/csv_dialects.hpp"
#include "../support/error_of.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/effects/wall_measurements.hpp"

using namespace downwash;
using test::CsvRows;
using test::Random;
using test::spelled;

namespace {

/// Rising distances of some thousandths, the first below 1.
std::vector<int> distances(Random& random, int count) {
    std::vector<int> all{random.integer(100, 900)};
    while (static_cast<int>(all.size()) < count) {
        all.push_back(all.back() + random.integer(10, 2000));
    }
    return all;
}

template <class Number>
std::vector<double> listed(const Number& numbers) {
    return {numbers.begin(), numbers.end()};
}

}  // namespace

TEST_CASE("Every dialect, encoding and end of line gives the numbers of a table of K") {
    Random random(1);
    for (const test::CsvDialect& dialect : test::csv_dialects()) {
        CAPTURE(dialect.name());
        const std::vector<int> z = distances(random, 3);
        const std::vector<int> d = distances(random, random.integer(1, 2));
        const bool has_d = d.size() > 1;
        CsvRows rows{{"z_over_r", "d_over_r", "factor"}};
        std::vector<double> factors;
        for (const int z_over_r : z) {
            for (const int d_over_r : d) {
                const int factor = random.integer(900, 2500);
                factors.push_back(factor / 1000.);
                rows.push_back({spelled(z_over_r, random), spelled(d_over_r, random), spelled(factor, random)});
            }
        }
        if (!has_d) {
            for (std::vector<std::string>& row : rows) {
                row.erase(row.begin() + 1);
            }
        }
        const auto table = parse_effect_table(test::csv_file(rows, dialect, random), "t.csv");
        REQUIRE(table->depends_on_d() == has_d);
        REQUIRE(listed(table->factors()) == factors);
        REQUIRE(listed(table->z_over_r()) == std::vector{z[0] / 1000., z[1] / 1000., z[2] / 1000.});
        if (has_d) {
            REQUIRE(listed(table->d_over_r()) == std::vector{d[0] / 1000., d[1] / 1000.});
        }
    }
}

TEST_CASE("Every dialect, encoding and end of line gives the numbers and words of measurements") {
    Random random(2);
    for (const test::CsvDialect& dialect : test::csv_dialects()) {
        CAPTURE(dialect.name());
        const bool has_words = dialect.variant != "names in a comment";  // which need numbers below them
        CsvRows rows{{"sigma", "z_over_r", "thrust_ratio"}};
        if (has_words) {
            rows[0].push_back("surface");
        }
        const std::vector<int> z = distances(random, 4);
        std::vector<int> ratios;
        for (const int z_over_r : z) {
            ratios.push_back(random.integer(1, 3000));
            rows.push_back({spelled(20, random), spelled(z_over_r, random), spelled(ratios.back(), random)});
            if (has_words) {
                rows.back().push_back(rows.size() % 2 == 0 ? "ground" : "ceiling");
            }
        }
        const Measurements found = parse_measurements(test::csv_file(rows, dialect, random), "m.csv");
        REQUIRE(found.points.size() == 4);
        for (std::size_t i = 0; i < 4; ++i) {
            REQUIRE(found.points[i].z_over_r == z[i] / 1000.);
            REQUIRE(found.points[i].thrust_ratio == ratios[i] / 1000.);
            REQUIRE(found.points[i].sigma == 0.02);
        }
        if (has_words) {
            REQUIRE(found.entries("surface") == std::vector<std::string>{"ground", "ceiling"});
        }
    }
}

TEST_CASE("Every dialect, encoding and end of line gives the numbers of measurements beside a wall") {
    Random random(3);
    for (const test::CsvDialect& dialect : test::csv_dialects()) {
        CAPTURE(dialect.name());
        CsvRows rows{{"distance_over_r", "force_over_thrust", "moment_over_thrust_radius"}};
        std::vector<std::vector<int>> numbers;
        for (int i = 0; i < 3; ++i) {
            numbers.push_back({random.integer(1000, 4000), random.integer(-999, -1), random.integer(-9000, 9000)});
            rows.push_back({});
            for (const int number : numbers.back()) {
                rows.back().push_back(spelled(number, random));
            }
        }
        const auto found = parse_wall_measurements(test::csv_file(rows, dialect, random), "w.csv").points;
        REQUIRE(found.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            REQUIRE(found[i].distance_over_r == numbers[i][0] / 1000.);
            REQUIRE(found[i].force_over_thrust == numbers[i][1] / 1000.);
            REQUIRE(found[i].moment_over_thrust_radius == numbers[i][2] / 1000.);
        }
    }
}

TEST_CASE("What spreadsheets and scripts make of one table is that table, or an error that says what is wrong") {
    const std::string plain = "z_over_r,thrust_ratio\n0.5,1.21\n0.75,1.105\n1,1.058\n1.5,1.027\n2,1.013\n3,1.004\n";
    const std::vector<double> expected{0.5, 1.21, 0.75, 1.105, 1, 1.058, 1.5, 1.027, 2, 1.013, 3, 1.004};
    const auto all = [&plain](char from, const std::string& to) {
        std::string text;
        for (const char c : plain) {
            text += c == from ? to : std::string(1, c);
        }
        return text;
    };
    const auto values = [](const std::string& text) {
        std::vector<double> found;
        for (const Measurement& point : parse_measurements(text, "m.csv").points) {
            found.push_back(point.z_over_r);
            found.push_back(point.thrust_ratio);
        }
        return found;
    };
    const auto error = [](const std::string& text) {
        return test::error_of([&] { return parse_measurements(text, "m.csv"); });
    };
    CHECK(values(plain) == expected);
    CHECK(values(all(',', ";")) == expected);
    CHECK(values(all(',', "\t")) == expected);
    CHECK(values("Z_over_R,Thrust_Ratio" + plain.substr(plain.find('\n'))) == expected);
    CHECK(
        values(
            "\"z_over_r\",\"thrust_ratio\"\n\"0,5\",\"1,21\"\n\"0,75\",\"1,105\"\n\"1,0\",\"1,058\"\n\"1,5\",\"1,027\""
            "\n\"2,0\",\"1,013\"\n\"3,0\",\"1,004\"\n") == expected);
    CHECK(values("z_over_r,thrust_ratio\n1.0e0,1.05\n+1.5,1.03\n.5,1.2\n2.,1.01\n") ==
          std::vector<double>{1, 1.05, 1.5, 1.03, 0.5, 1.2, 2, 1.01});
    // One message, whatever the number of lines.
    CHECK(error("z_over_r;thrust_ratio\n0.5,1.21\n0.75,1.105\n1,1.058\n") ==
          "m.csv:2: holds 1 cell: expected 2, one for each column of line 1; separate it as the names, by ';'");
    CHECK(error("z_over_r,thrust_ratio\n0,5,1,21\n0,75,1,105\n1,0,1,058\n") ==
          "m.csv:2: holds 4 cells: expected 2, one for each column of line 1; if its numbers have decimal commas, "
          "separate the columns by ';' or quote the numbers");
    CHECK(error("z/R, T/T_inf\n0.5,1.21\n") ==
          "m.csv:1: has no column z_over_r in 'z/R, T/T_inf': expected z_over_r and thrust_ratio\n"
          "m.csv:1: has no column thrust_ratio in 'z/R, T/T_inf': expected z_over_r and thrust_ratio");
    CHECK(error("z_over_r,thrust_ratio\n\xE2\x88\x92"
                "1,1.5\n") ==
          "m.csv:2:1: z_over_r is '\xE2\x88\x92"
          "1': expected a number from 1e-06 to 1000; write its minus sign as '-', not as U+2212");
    CHECK(error("z_over_r,thrust_ratio,sigma\n0.5,1.21,0\n") ==
          "m.csv:2:10: sigma is '0': expected a number from 1e-09 to 100");
    CHECK(error("z_over_r,thrust_ratio\n0.5,121\n") ==
          "m.csv:2:5: thrust_ratio is '121': expected a number from 0 to 100");
}
