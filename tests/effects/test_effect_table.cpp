#include <math.h>  // NOLINT(modernize-deprecated-headers): Boost 1.74 wants ::isnan

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/random.hpp"
#include "downwash/effects/effect_table.hpp"

using namespace downwash;
using Catch::Matchers::Equals;
using downwash::test::Random;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> random_axis(Random& random, int count) {
    std::vector<double> axis{random.uniform(0, 0.5)};
    while (static_cast<int>(axis.size()) < count) {
        axis.push_back(axis.back() + random.uniform(0.01, 1));
    }
    return axis;
}

std::vector<double> random_factors(Random& random, std::size_t count) {
    std::vector<double> factors(count);
    std::generate(factors.begin(), factors.end(), [&random] { return random.uniform(0.5, 2); });
    return factors;
}

double boost_pchip(std::vector<double> x, std::vector<double> y, double at) {
    return boost::math::interpolators::pchip(std::move(x), std::move(y))(at);
}

std::string repeated(const std::string& line, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) {
        text += line;
    }
    return text;
}

std::string error_of(const std::string& text) {
    return test::error_of([&] { return parse_effect_table(text, "t.csv"); });
}

}  // namespace

TEST_CASE("A table over zeta has the hand-computed values") {
    // Secants -0.4 and -0.1, intervals of 1: the slope at 1 is 6 / (3 / -0.4 + 3 / -0.1) = -0.16.
    const EffectTable table({0, 1, 2}, {}, {1.6, 1.2, 1.1});
    const auto curve = table.at();
    CHECK(curve(0) == 1.6);
    CHECK(curve(1) == 1.2);
    CHECK(curve(2) == 1.1);
    // Halfway: mean of the values plus h/8 times the difference of the slopes.
    CHECK(curve(0.5) == Approx(1.4 + (-0.4 + 0.16) / 8).epsilon(1e-14));
    CHECK(curve(1.5) == Approx(1.15 + (-0.16 + 0.1) / 8).epsilon(1e-14));
    // Beyond: 0.1 (2 / zeta)^2.
    CHECK(curve(4) == Approx(1.025).epsilon(1e-14));
    CHECK(curve(infinity) == 1);
    // Nearer than its first distance a table holds its first value.
    const EffectTable straight({0.3, 1}, {}, {1.6, 1.2});
    CHECK(straight.at()(0) == 1.6);
    CHECK(straight.at()(0.3) == 1.6);
    CHECK(straight.at()(0.65) == Approx(1.4).epsilon(1e-14));  // two nodes: a straight line
}

TEST_CASE("A table over zeta is Boost's monotone interpolation") {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        const std::vector<double> z = random_axis(random, random.integer(4, 12));
        const std::vector<double> k = random_factors(random, z.size());
        const EffectTable table(z, {}, k);
        for (int i = 0; i < 50; ++i) {
            const double at = random.uniform(z.front(), z.back());
            REQUIRE(table.at()(at) == Approx(boost_pchip(z, k, at)).epsilon(1e-12));
        }
    }
}

TEST_CASE("A table over zeta and d is Boost's monotone interpolation along d, then along zeta") {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const std::vector<double> z = random_axis(random, random.integer(4, 8));
        const std::vector<double> d = random_axis(random, random.integer(4, 8));
        const std::vector<double> k = random_factors(random, z.size() * d.size());
        const EffectTable table(z, d, k);
        for (int i = 0; i < 20; ++i) {
            const double at_d = i == 0 ? d.back() : random.uniform(d.front(), d.back());
            std::vector<double> column;
            for (std::size_t row = 0; row < z.size(); ++row) {
                const auto first = k.begin() + static_cast<std::ptrdiff_t>(row * d.size());
                column.push_back(boost_pchip(d, {first, first + static_cast<std::ptrdiff_t>(d.size())}, at_d));
            }
            const double at_z = random.uniform(z.front(), z.back());
            REQUIRE(table.at(at_d)(at_z) == Approx(boost_pchip(z, column, at_z)).epsilon(1e-12));
        }
    }
}

TEST_CASE("A table that does not vary with d is the table over zeta alone") {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        const std::vector<double> z = random_axis(random, random.integer(2, 6));
        const std::vector<double> d = random_axis(random, random.integer(2, 4));
        const std::vector<double> k = random_factors(random, z.size());
        std::vector<double> repeated;
        for (const double value : k) {
            repeated.insert(repeated.end(), d.size(), value);
        }
        const EffectTable plain(z, {}, k), wide(z, d, repeated);
        for (int i = 0; i < 50; ++i) {
            const double at = random.uniform(0, z.back() + 2);
            REQUIRE(wide.at(random.uniform(-1, 5))(at) == Approx(plain.at()(at)).epsilon(1e-13));
        }
    }
}

TEST_CASE("A table never leaves the range of the nodes around, and d that of the table") {
    Random random(4);
    for (int round = 0; round < 100; ++round) {
        const std::vector<double> z = random_axis(random, random.integer(2, 6));
        const std::vector<double> d = random_axis(random, random.integer(2, 6));
        const std::vector<double> k = random_factors(random, z.size() * d.size());
        const EffectTable table(z, d, k);
        for (int i = 0; i < 100; ++i) {
            const auto row = static_cast<std::size_t>(random.integer(0, static_cast<int>(z.size()) - 2));
            const auto column = static_cast<std::size_t>(random.integer(0, static_cast<int>(d.size()) - 2));
            const double at_z = random.uniform(z[row], z[row + 1]);
            const double at_d = random.uniform(d[column], d[column + 1]);
            const std::size_t corner = row * d.size() + column;
            const auto [low, high] =
                std::minmax({k[corner], k[corner + 1], k[corner + d.size()], k[corner + d.size() + 1]});
            const double factor = table.at(at_d)(at_z);
            REQUIRE(factor >= low);
            REQUIRE(factor <= high);
        }
        const double at = random.uniform(0, z.back() + 1);
        CHECK(table.at(-1)(at) == table.at(d.front())(at));
        CHECK(table.at(infinity)(at) == table.at(d.back())(at));
    }
}

TEST_CASE("Falling measurements give a falling curve that keeps falling beyond them") {
    Random random(5);
    for (int round = 0; round < 100; ++round) {
        const std::vector<double> z = random_axis(random, 6);
        std::vector<double> k = random_factors(random, 6);
        std::sort(k.begin(), k.end(), std::greater<>());
        const EffectTable table(z, {}, k);
        double before = infinity;
        for (double at = 0; at < z.back(); at += 0.01) {
            const double factor = table.at()(at);
            REQUIRE(factor <= before);
            before = factor;
        }
        const double end = std::abs(k.back() - 1);
        CHECK(std::abs(table.at()(2 * z.back()) - 1) == Approx(end / 4));
    }
}

TEST_CASE("The largest change beyond a distance bounds every change beyond it") {
    Random random(6);
    for (int round = 0; round < 100; ++round) {
        const std::vector<double> z = random_axis(random, random.integer(2, 6));
        const std::vector<double> d = random_axis(random, 3);
        const EffectTable table(z, d, random_factors(random, z.size() * d.size()));
        double before = infinity;
        for (double from = 0; from < 10; from += 0.37) {
            const double bound = table.largest_change_beyond(from);
            REQUIRE(bound <= before);
            before = bound;
            for (int i = 0; i < 20; ++i) {
                const double at = from + random.uniform(0, 3);
                REQUIRE(std::abs(table.at(random.uniform(0, 4))(at) - 1) <= bound * (1 + 1e-12));
            }
        }
    }
    const EffectTable fountain({1, 2, 4}, {}, {0.9, 1.3, 1.1});
    CHECK(fountain.largest_change_beyond(0) == Approx(0.3));
    CHECK(fountain.largest_change_beyond(2) == Approx(0.3));
    CHECK(fountain.largest_change_beyond(4) == Approx(0.1));
    CHECK(fountain.largest_change_beyond(8) == Approx(0.025));
    CHECK(fountain.largest_change_beyond(infinity) == 0);
}

TEST_CASE("A table is read from rows in any order") {
    const auto table = parse_effect_table(
        "# tandem rotors, smoke visualisation\r\n\r\nd_over_r , z_over_r, thrust_ratio\r\n"
        "2, 1, 1.1\n# between\n1, 1, 1.2\n1,2,0.95\n2,2,1",
        "t.csv");
    CHECK(table->depends_on_d());
    CHECK_THAT(std::vector<double>(table->z_over_r().begin(), table->z_over_r().end()), Equals(std::vector{1.0, 2.0}));
    CHECK_THAT(std::vector<double>(table->d_over_r().begin(), table->d_over_r().end()), Equals(std::vector{1.0, 2.0}));
    CHECK_THAT(std::vector<double>(table->factors().begin(), table->factors().end()),
               Equals(std::vector{1.2, 1.1, 0.95, 1.0}));
    const auto plain = parse_effect_table("z_over_r,factor\n2,1.1\n1,1.5\n", "t.csv");
    CHECK_FALSE(plain->depends_on_d());
    // With the index that pandas writes, of a spreadsheet with decimal commas.
    CHECK(parse_effect_table(";z_over_r;factor\n0;1;1,5\n1;2;1,1\n", "t.csv")->at()(1) == 1.5);
    CHECK(parse_effect_table("Unnamed: 0,z_over_r,factor\n0,1,1.5\n1,2,1.1\n", "t.csv")->at()(1) == 1.5);
    CHECK(plain->at()(1) == 1.5);
    const auto noted = parse_effect_table("z_over_r,factor,rpm\n1,1.5,4000\n2,1.1,4000\n", "t.csv");
    CHECK(noted->at()(1) == 1.5);
    CHECK(noted->csv().others == std::vector<std::string>{"rpm"});
}

TEST_CASE("Tables that cannot be used are errors with their line") {
    const std::string head = "z_over_r,factor\n";
    const std::string with_d = "z_over_r,d_over_r,factor\n";
    const std::string columns = "expected z_over_r,factor or z_over_r,d_over_r,factor";
    const std::string no_factor = ": expected a number from 0 to 100";
    for (const auto& [text, error] : {
             std::pair<std::string, std::string>{
                 "", ": holds no table: expected a line with the names of its columns, then rows"},
             {"# nothing\n", ": holds no table: expected a line with the names of its columns, then rows"},
             {head, ":1: no rows follow: expected a table of two or more distances"},
             {"#\nz_over_r:factor\n1:2\n", ":2: has the columns 'z_over_r:factor': " + columns},
             {"z_over_r,K\n1,2\n", ":1: has the columns 'z_over_r, K': " + columns},
             {"z_over_r,factor [-]\n1,2\n",
              ":1: has the columns 'z_over_r, factor [-]': " + columns + "; write 'factor [-]' as factor"},
             {"z_over_r,z_over_r\n", ":1:10: the column 'z_over_r' occurs twice"},
             {head + "1,1.2,3\n", ":2: holds 3 cells: expected 2, one for each column of line 1"},
             {head + "1,1.2\n\n2,\n", ":4:3: factor is ''" + no_factor},
             {head + "1,nan\n2,inf\n3,-0.1\n4,101\n5,1.2x\n",
              ":2:3: factor is 'nan'" + no_factor + "\nt.csv:3:3: factor is 'inf'" + no_factor +
                  "\nt.csv:4:3: factor is '-0.1'" + no_factor + "\nt.csv:5:3: factor is '101'" + no_factor +
                  "\nt.csv:6:3: factor is '1.2x'" + no_factor},
             {head + "-1,1.2\n2,1\n", ":2:1: z_over_r is '-1': expected a number from 0 to 1000"},
             {head + "1,1.2\n1.0,1.1\n", ": z_over_r is 1 in every row: expected two or more distances"},
             {head + "1,1.2\n2,1.1\n1.0,1.3\n",
              ":4: z_over_r 1 is already in line 2; a second distance is a column d_over_r"},
             {head + "1,1.2\n1.0000001,1.1\n",
              ":3: z_over_r 1.0000001 is hardly above 1: expected steps of at least 1e-6, or exactly the same "
              "number"},
             {with_d + "1,1,1\n1,2,1\n2,1,1\n",
              ": has no row for z_over_r 2, d_over_r 2: expected one for every combination of distances"},
             {with_d + "1,1,1\n2,1,1\n",
              ": d_over_r is 1 in every row: expected two or more distances, or no such column"},
         }) {
        CHECK(error_of(text) == "t.csv" + error);
    }
}

TEST_CASE("Long files are errors before they fill the memory, and not every error is told") {
    CHECK(error_of("z_over_r,factor\n" + repeated("1,1\n", 100'001)) ==
          "t.csv:100002: is row 100001: expected at most 100000");
    const std::string errors = error_of("z_over_r,factor\n" + repeated("x,1\n", 1000));
    CHECK(std::count(errors.begin(), errors.end(), '\n') == 20);
    CHECK_THAT(errors, Catch::EndsWith(": and 980 more errors"));
    // Distances that make a grid of 2.5e9 nodes where there are 50000 rows.
    std::string sparse = "z_over_r,d_over_r,factor\n";
    for (int i = 0; i < 50'000; ++i) {
        sparse += std::to_string(i * 0.01) + "," + std::to_string(i * 0.1) + ",1\n";
    }
    CHECK_THAT(error_of(sparse), Catch::Contains("has no row for z_over_r 0, d_over_r 0.1:"));
}

TEST_CASE("Tables made in a program are checked too") {
    CHECK_THROWS_AS(EffectTable({1}, {}, {1}), InputError);
    CHECK_THROWS_AS(EffectTable({}, {}, {}), InputError);
    CHECK_THROWS_AS(EffectTable({1, 1}, {}, {1, 1}), InputError);
    CHECK_THROWS_AS(EffectTable({2, 1}, {}, {1, 1}), InputError);
    CHECK_THROWS_AS(EffectTable({1, std::nan("")}, {}, {1, 1}), InputError);
    CHECK_THROWS_AS(EffectTable({1, 2}, {}, {1, std::nan("")}), InputError);
    CHECK_THROWS_AS(EffectTable({1, 2}, {}, {1, 1, 1}), InputError);
    CHECK_THROWS_AS(EffectTable({1, 2}, {1}, {1, 1}), InputError);
    CHECK_THROWS_AS(EffectTable({1, 2}, {1, 2}, {1, 1}), InputError);
}
