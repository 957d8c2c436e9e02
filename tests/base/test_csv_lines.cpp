#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/csv_lines.hpp"
#include "downwash/base/line_errors.hpp"

using namespace downwash;

namespace {

using Cells = std::vector<std::pair<std::string, std::size_t>>;

Cells cells_of(const CsvLines& line) {
    Cells cells;
    line.for_each_cell([&](std::string_view cell, std::size_t column) { cells.emplace_back(cell, column); });
    return cells;
}

}  // namespace

TEST_CASE("comma separated text is read line by line, whatever ends the lines") {
    CsvLines lines("\xEF\xBB\xBF# made by hand\n\n \t\r\n a, b ,\r\n,c");
    REQUIRE(lines.next());
    CHECK(lines.number() == 1);
    REQUIRE(lines.is_comment());
    CHECK(lines.comment() == " made by hand");
    REQUIRE(lines.next());
    CHECK(lines.number() == 4);
    CHECK_FALSE(lines.is_comment());
    CHECK(cells_of(lines) == Cells{{"a", 1}, {"b", 4}, {"", 8}});
    REQUIRE(lines.next());
    CHECK(lines.number() == 5);
    CHECK(cells_of(lines) == Cells{{"", 1}, {"c", 2}});
    CHECK_FALSE(lines.next());
    CHECK_FALSE(CsvLines("").next());
    CHECK_FALSE(CsvLines("\n \n").next());
}

TEST_CASE("errors of a file name their lines, and the twentieth ends the reading") {
    LineErrors errors("a.csv");
    errors.throw_any();
    errors.add(0, "is empty");
    errors.add(3, "is short");
    errors.add(4, 7, "is no number");
    CHECK_THROWS_WITH(errors.throw_any(), "a.csv: is empty\na.csv:3: is short\na.csv:4:7: is no number");
    for (std::size_t line = 4; line < 20; ++line) {
        errors.add(line, "is wrong");
    }
    CHECK_THROWS_AS(errors.add(20, "is wrong"), InputError);
}
