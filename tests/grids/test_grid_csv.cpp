#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>

#include "../support/error_of.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "grids.hpp"

using namespace downwash;

namespace {

std::string error_of(const std::string& text) {
    return test::error_of([&] { return parse_factor_grid(text, "g.csv"); });
}

}  // namespace

TEST_CASE("a measured grid is read whatever the order of its rows and columns") {
    const FactorGrid grid = parse_factor_grid(
        "# measured: in the hangar\n"
        "#\n"
        "# a remark\n"
        "factor, z_m, rpm, x_m\r\n"
        "1.4, 1.5, 900, 0.5\r\n"
        "1.1, 1, 900, 0\r\n"
        "\r\n"
        "1.2, 1, 900, 0.5\r\n"
        "1.3, 1.5, , 0\r\n",
        "g.csv");
    CHECK(grid.is_planar());
    CHECK(grid.x() == GridAxis{0, 0.5, 2});
    CHECK(grid.z() == GridAxis{1, 1.5, 2});
    CHECK(*grid.field("factor") == std::vector<double>{1.1, 1.2, 1.3, 1.4});
    CHECK(grid.provenance() == Provenance{{"measured", "in the hangar"}, {"comment", "a remark"}});
    CHECK(grid.factor({0.25, 7, 1}) == Approx(1.15));
}

TEST_CASE("plane coordinates belong to the plane of the reader unless the file names its own") {
    const std::string rows = "x_m,z_m,factor\n0,0,1\n1,0,2\n0,1,1\n1,1,2\n";
    const PlaneOfMotion plane({100, 0, 0}, 0);
    CHECK(parse_factor_grid(rows, "g.csv", plane).contains({100.5, 0, 0.5}));
    const FactorGrid own =
        parse_factor_grid("# frame_origin_m: 0 50 0\n# frame_heading_rad: 0\n" + rows, "g.csv", plane);
    CHECK(own.contains({0.5, 50, 0.5}));
    CHECK(own.provenance().empty());
    // World coordinates need no plane.
    const FactorGrid volume = parse_factor_grid(
        "x_m,y_m,z_m,factor\n0,0,0,1\n1,0,0,2\n0,1,0,1\n1,1,0,2\n0,0,1,1\n1,0,1,2\n0,1,1,1\n1,1,1,2\n", "g.csv", plane);
    CHECK(volume.factor({0.5, 0.5, 0.5}) == 1.5);
}

TEST_CASE("the CSV that ParaView saves is read, whatever the form of its names") {
    // Of an image of 2 x 2 x 2 points, as Save Data writes it.
    const FactorGrid grid = parse_factor_grid(
        "\"factor\",\"Points:0\",\"Points:1\",\"Points:2\",\"rho\"\n1,0,0,0,9\n1.5,1,0,0,9\n2,0,2,0,9\n2.5,1,2,0,9\n"
        "3,0,0,4,9\n3.5,1,0,4,9\n4,0,2,4,9\n4.5,1,2,4,9\n",
        "g.csv");
    CHECK_FALSE(grid.is_planar());
    CHECK(grid.y() == GridAxis{0, 2, 2});
    CHECK(*grid.field("factor") == std::vector<double>{1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5});
}

TEST_CASE("a grid that other programs rounded is read, and covers what it did") {
    // Of an awkward place and step, as a problem's bounds give them.
    FactorGridParts parts;
    parts.x = {-8.32631234567, 9.4181234567, 56};
    parts.z = {-0.32262676432, 7.4404567891, 25};
    parts.lateral_offsets_m = {-0.18123456, 0.18123456};
    parts.fields = {{"factor", std::vector<double>(2 * 56 * 25, 1.25)}};
    const FactorGrid exact(parts);
    const std::string text = grid_csv_text(exact);
    const auto rounded = [&text](const char* format) {
        std::size_t at = text.find('\n', text.find("lateral_m")) + 1;
        std::string rows = text.substr(0, at);
        while (at < text.size()) {
            const std::size_t end = text.find_first_of(",\n", at);
            std::array<char, 64> cell{};
            std::snprintf(cell.data(), cell.size(), format, std::stod(text.substr(at, end - at)));
            rows += cell.data() + text.substr(end, 1);
            at = end + 1;
        }
        return rows;
    };
    for (const char* format : {"%.5g", "%.6g", "%.9g", "%.4f", "%.5f", "%.6f", "%.9f", "%.6e", "%.18e"}) {
        CAPTURE(format);
        const FactorGrid grid = parse_factor_grid(rounded(format), "g.csv");
        CHECK(grid.x().count == 56);
        CHECK(grid.z().count == 25);
        for (const double x_m : {parts.x.low_m, parts.x.high_m}) {
            for (const double y_m : parts.lateral_offsets_m) {
                for (const double z_m : {parts.z.low_m, parts.z.high_m}) {
                    CHECK(grid.factor({x_m, y_m, z_m}) == 1.25);
                }
            }
        }
        // Nothing is extrapolated beyond that.
        CHECK_FALSE(grid.contains({parts.x.low_m - 1.1e-3, parts.lateral_offsets_m[0], 1}));
        CHECK_FALSE(grid.contains({0, parts.lateral_offsets_m[0] + 1e-4, 1}));
        CHECK_FALSE(grid.contains({0, parts.lateral_offsets_m[0], parts.z.high_m + 2e-4}));
    }
    // Short numbers are no rounded ones.
    const FactorGrid plain =
        parse_factor_grid("x_m,z_m,factor\n0,0,1\n0.5,0,1\n1,0,1\n0,1,1\n0.5,1,1\n1,1,1\n", "g.csv");
    CHECK_FALSE(plain.contains({1.0002, 0, 0}));
    // Numbers so short that nodes may be anywhere between are an error, not a guess.
    CHECK_THAT(error_of("x_m,z_m,factor\n0.0,0,1\n0.1,0,1\n0.3,0,1\n0.0,1,1\n0.1,1,1\n0.3,1,1\n"),
               Catch::StartsWith("g.csv:3:1: x_m is 0.1: expected 0.15"));
}

TEST_CASE("a grid of another program's dialect is the same grid") {
    const FactorGrid grid = parse_factor_grid("x_m,z_m,factor\n0,0,1\n0.5,0,1.5\n0,1,2\n0.5,1,2.5\n", "g.csv");
    for (const char* text : {
             "x_m;z_m;factor\r\n0;0;1\r\n0,5;0;1,5\r\n0;1;2\r\n0,5;1;2,5\r\n",
             ",x_m,z_m,factor\n0,0.0,0.0,1.0\n1,0.5,0.0,1.5\n2,0.0,1.0,2.0\n3,0.5,1.0,2.5\n",
             "# x_m z_m factor\n0.000000 0.000000 1.000000\n0.500000 0.000000 1.500000\n0.000000 1.000000 2.000000\n"
             "0.500000 1.000000 2.500000\n",
             "# frame_origin_m: 0 0 0,,\n# frame_heading_rad: "
             "0,,\nx_m,z_m,factor\n0,0,1\n0.5,0,1.5\n0,1,2\n0.5,1,2.5\n",
         }) {
        CAPTURE(text);
        CHECK(test::is_same(parse_factor_grid(text, "g.csv"), grid));
    }
    const FactorGrid volume = parse_factor_grid(
        "\"factor\",\"Points_0\",\"Points_1\",\"Points_2\"\n1,0,0,0\n1.5,1,0,0\n2,0,2,0\n2.5,1,2,0\n3,0,0,4\n3.5,1,0,"
        "4\n"
        "4,0,2,4\n4.5,1,2,4\n",
        "g.csv");
    CHECK(volume.y() == GridAxis{0, 2, 2});
}

TEST_CASE("a VTK file is an error that says how to come to CSV") {
    const std::string remedy = error_of(vti_text(FactorGrid(test::two_by_two())));
    CHECK(remedy.starts_with("g.csv:1:1: VTK's XML is written by Downwash, not read: expected CSV"));
    CHECK(remedy.find("Save Data") != std::string::npos);
}

TEST_CASE("a grid survives CSV to the bit, and its text to the byte") {
    CHECK(test::comes_back(grid_csv_text, [](const std::string& text) { return parse_factor_grid(text, "g.csv"); }));
}

TEST_CASE("every error of a CSV grid is told with its line") {
    const std::string head = "x_m,z_m,factor\n";
    const std::string columns = "expected x_m,z_m,factor or x_m,y_m,z_m,factor";
    const std::string off_node = ", as the 5 coordinates from 0 to 0.3 are 0.075 apart if they are equally spaced";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "g.csv: holds no table: expected a line with the names of its columns, then rows"},
        {"# only this\n", "g.csv: holds no table: expected a line with the names of its columns, then rows"},
        {head, "g.csv: holds no row"},
        {"x,z,k\n0,0,1\n", "g.csv:1: has no column x_m in 'x, z, k': " + columns +
                               "\ng.csv:1: has no column z_m in 'x, z, k': " + columns +
                               "\ng.csv:1: has no column factor in 'x, z, k': " + columns},
        {"x_m,z_m,factor,x_m\n", "g.csv:1:16: the column 'x_m' occurs twice"},
        {"x_m,y_m,lateral_m,z_m,factor\n",
         "g.csv:1: expected lateral_m (layers beside the plane) or y_m (a volume), not both"},
        {head + "0,0,1\n1,0,nan\n0,one,1\n1,1e7,-1\n",
         "g.csv:3:5: factor is 'nan': expected a number from 0 to 100\n"
         "g.csv:4:3: z_m is 'one': expected a number from -1000000 to 1000000\n"
         "g.csv:5:3: z_m is '1e7': expected a number from -1000000 to 1000000\n"
         "g.csv:5:7: factor is '-1': expected a number from 0 to 100"},
        {head + "0,0\n", "g.csv:2: holds 2 cells: expected 3, one for each column of line 1"},
        {head + "0,0,1,2.5\n", "g.csv:2: holds 4 cells: expected 3, one for each column of line 1"},
        {head + "0,0,1\n1,0,1\n0,1,1\n1,1,1\n1,0,2\n", "g.csv:6:1: repeats the position of line 3"},
        {head + "0,0,1\n1,0,1\n0,1,1\n",
         "g.csv: there is no row at x_m 1, z_m 1, the first of 1 holes: expected every combination of the coordinates"},
        {head + "0,0,1\n0,1,1\n", "g.csv: column x_m holds 0 only: expected two or more coordinates"},
        {"x_m,y_m,z_m,factor\n0,3,0,1\n1,3,0,1\n0,3,1,1\n1,3,1,1\n",
         "g.csv: column y_m holds 3 only: expected two or more coordinates, or no such column for a planar grid"},
        {head + "0,0,1\n0.1,0,1\n0.21,0,1\n0.3,0,1\n0,1,1\n0.1,1,1\n0.2,1,1\n0.3,1,1\n",
         "g.csv:3:1: x_m is 0.1: expected 0.075" + off_node + "\ng.csv:4:1: x_m is 0.21: expected 0.225" + off_node +
             "\ng.csv:7:1: x_m is 0.1: expected 0.075" + off_node + "\ng.csv:8:1: x_m is 0.2: expected 0.225" +
             off_node},
        {"# frame_origin_m: 1 2\n" + head, "g.csv:1:1: '1 2': expected 3 finite numbers"},
        {"# frame_heading_rad: inf\n" + head, "g.csv:1:1: 'inf': expected 1 finite number"},
    };
    for (const auto& [text, message] : cases) {
        CHECK(error_of(text).substr(0, message.size()) == message);
    }
    CHECK(error_of(head + "0,0,1\n1,0,1\n0,1,1\n1,1,1\n") == "none");
    // Coordinates may be off their nodes by a millionth of a step, not more.
    const auto with_middle = [&head](const std::string& x) {
        return head + "0,0,1\n" + x + ",0,1\n2,0,1\n0,1,1\n" + x + ",1,1\n2,1,1\n";
    };
    CHECK(error_of(with_middle("1.0000009")) == "none");
    CHECK(error_of(with_middle("1.0000011")).starts_with("g.csv:3:1: x_m is 1.0000011"));
}

TEST_CASE("many errors do not make an endless message, many coordinates no large grid") {
    std::string text = "x_m,z_m,factor\n";
    for (int i = 0; i < 1000; ++i) {
        text += "a,b,c\n";
    }
    const std::string message = error_of(text);
    CHECK(std::count(message.begin(), message.end(), '\n') == 20);  // the last one says how many more there are

    text = "x_m,z_m,factor\n";
    for (int i = 0; i < 10000; ++i) {
        text += std::to_string(i) + "," + std::to_string(i) + ",1\n";
    }
    CHECK(error_of(text) == "g.csv: has 10000 rows for 100000000 combinations of its coordinates: expected one each");
}

TEST_CASE("a file of a byte more than two GiB is told by its size") {
    const test::ScratchFolder folder;
    const auto file = folder / "huge.csv";
    write_file(file, "");
    std::filesystem::resize_file(file, 2147483649);  // sparse: it takes no space
    CHECK(test::error_of([&] { return read_factor_grid(file); }) ==
          file.string() + " is larger than 2048 MiB: expected a smaller file");
}

TEST_CASE("files of grids are written by their name") {
    const test::ScratchFolder folder;
    test::Random random(4);
    const FactorGrid grid = test::any_grid(random);
    write_factor_grid(folder / "grid.csv", grid);
    CHECK(test::is_same(read_factor_grid(folder / "grid.csv"), grid));
    write_factor_grid(folder / "grid.vti", grid);
    CHECK(read_file(folder / "grid.vti", 5) == "<?xml");
    CHECK_THROWS_WITH(write_factor_grid(folder / "grid.txt", grid),
                      Catch::EndsWith("grid.txt ends in '.txt': expected .vti (VTK ImageData) or .csv"));
    CHECK_THROWS_WITH(write_factor_grid(folder / "missing/grid.csv", grid),
                      Catch::EndsWith("grid.csv cannot be written: No such file or directory"));
    CHECK_THROWS_WITH(read_factor_grid(folder / "missing.csv"),
                      Catch::EndsWith("missing.csv cannot be read: there is no such file"));
}
