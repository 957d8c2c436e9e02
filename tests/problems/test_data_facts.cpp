#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "downwash/base/files.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/problems/data_facts.hpp"

using namespace downwash;
using Catch::Contains;

namespace {

using Names = std::vector<std::string>;

Names names(const std::vector<CsvColumn>& columns) {
    Names all;
    for (const CsvColumn& column : columns) {
        all.push_back(column.name);
    }
    return all;
}

DataFacts read(const std::string& text) {
    const test::ScratchFolder folder;
    write_file(folder / "data.csv", text);
    return read_data_file(folder / "data.csv");
}

}  // namespace

TEST_CASE("The columns of a file of numbers tell its kind, and its dialect is told") {
    const DataFacts grid = read("# from a test\nx_m,z_m,factor,pressure\n0,0,1,7\n1,0,1,7\n0,1,1,7\n1,1,1.1,7\n");
    CHECK(grid.kind == DataKind::grid);
    CHECK(grid.key.empty());
    CHECK(grid.csv.rows == 4);
    CHECK(grid.csv.separator == ',');
    CHECK(grid.csv.decimal_sign == '.');
    CHECK(names(grid.csv.used) == Names{"x_m", "z_m", "factor"});
    CHECK(grid.csv.others == Names{"pressure"});

    const DataFacts paraview = read(
        "Points:0;Points:1;Points:2;factor\n0;0;0;1\n1;0;0;1,5\n0;0;1;1\n1;0;1;1\n"
        "0;1;0;1\n1;1;0;1,5\n0;1;1;1\n1;1;1;1\n");
    CHECK(paraview.kind == DataKind::grid);
    CHECK(paraview.csv.separator == ';');
    CHECK(paraview.csv.decimal_sign == ',');
    CHECK(paraview.csv.used.front().name == "Points:0");

    const DataFacts table = read("z_over_r\tfactor\n0.5\t1.3\n1\t1.1\n2\t1\n");
    CHECK(table.kind == DataKind::effect_table);
    CHECK(table.csv.rows == 3);
    CHECK(table.csv.separator == '\t');

    const DataFacts measured = read("source,z_over_r,thrust_ratio,sigma\nbench,1,1.1,\nbench,2,1.05,\n");
    CHECK(measured.kind == DataKind::measurements);
    CHECK(names(measured.csv.used) == Names{"source", "z_over_r", "thrust_ratio"});
    CHECK(measured.csv.others == Names{"sigma"});  // whose cells are empty

    const DataFacts walls =
        read("distance_over_r force_over_thrust moment_over_thrust_radius\n1.5 0.01 0.02\n2.5 0.005 0.01\n");
    CHECK(walls.kind == DataKind::wall_measurements);
    CHECK(walls.csv.separator == ' ');
}

TEST_CASE("Ratios that are gains or percent, distances not in radii and columns that nothing reads are remarks") {
    const auto remarks = [](const std::string& text) { return data_remarks(read(text)); };
    CHECK(remarks("z_over_r,factor\n0.5,1.3\n4,1\n").empty());
    CHECK(remarks("z_over_r,factor\n0.5,0.9\n4,1\n").empty());  // a table may be below one near by
    const auto gains = remarks("z_over_r,factor\n0.5,0.3\n4,0.01\n");
    REQUIRE(gains.size() == 1);
    CHECK_THAT(gains[0], Contains("factor from 0.01 to 0.3, below 1 throughout") && Contains("to gains add 1"));
    const auto percent = remarks("z_over_r,thrust_ratio\n0.5,30\n4,1\n");
    REQUIRE(percent.size() == 1);
    CHECK_THAT(percent[0], Contains("thrust_ratio from 1 to 30, far above") && Contains("divide percent by 100"));
    CHECK(data_remarks(read("z_over_r,factor\n0.5,5\n4,1\n"), 3).empty());
    CHECK(remarks("x_m,z_m,factor\n0,0,0.02\n1,0,0.02\n0,1,0.02\n1,1,0.02\n").size() == 1);
    const auto far = remarks("z_over_r,factor\n100,1.3\n400,1.05\n");
    REQUIRE(far.size() == 1);
    CHECK_THAT(far[0], Contains("z_over_r from 100 to 400") && Contains("over the rotor radius"));
    const auto noted = remarks("z_over_r,factor,rpm,note\n0.5,1.3,1,a\n4,1,1,b\n");
    REQUIRE(noted.size() == 1);
    CHECK_THAT(noted[0], Contains("columns that are not read: rpm, note"));
    CHECK(remarks("source,z_over_r,thrust_ratio,rpm\na,0.5,1.3,7\n").empty());
}

TEST_CASE("Remarks on the files of a problem are among its warnings") {
    Problem problem = test::ceiling_problem();
    const std::size_t before = problem_warnings(problem).size();
    problem.aero.ceiling = EffectModel::table;
    problem.aero.ceiling.file = "k.csv";
    problem.aero.ceiling.table = parse_effect_table("z_over_r,factor\n0.5,0.3\n4,0.01\n", "k.csv");
    const std::vector<KeyError> warnings = problem_warnings(problem);
    REQUIRE(warnings.size() == before + 1);
    const auto found = std::find_if(warnings.begin(), warnings.end(),
                                    [](const KeyError& warning) { return warning.key == "aero.ceiling.file"; });
    REQUIRE(found != warnings.end());
    CHECK_THAT(found->message, Contains("'k.csv' has factor from 0.01 to 0.3"));
    problem.aero.enabled = false;
    CHECK(problem_warnings(problem).size() == before);
}

TEST_CASE("A file of numbers without columns of a kind, or with an error, is told with its line") {
    CHECK_THAT(test::error_of([] { return read("a,b\n1,2\n"); }),
               Contains("data.csv:1: has the columns 'a, b'") && Contains("an effect table (z_over_r,factor)"));
    CHECK_THAT(test::error_of([] { return read("throttle,thrust_g,power_w\n20,330,30\n"); }),
               Contains("a thrust stand gives rotors.max_thrust_n") && Contains("power_coefficient_w_n1p5"));
    CHECK_THAT(test::error_of([] { return read("z_over_r,thrust_ratio\n1,1.1\n2,much\n"); }),
               Contains("data.csv:3:3: thrust_ratio is 'much'"));
    CHECK_THAT(test::error_of([] { return read_data_file("nowhere.csv"); }), Contains("nowhere.csv"));
}

TEST_CASE("A problem tells of each file of numbers once") {
    const std::string text = "z_over_r;factor;\n0,5;1,3;\n1;1,1;\n2;1;\n";
    Problem problem = test::ceiling_problem();
    CHECK(data_facts(problem).empty());
    for (SurfaceEffect* side : {&problem.aero.ground, &problem.aero.ceiling}) {
        *side = EffectModel::table;
        side->file = "k.csv";
        side->table = parse_effect_table(text, "k.csv");
    }
    const std::vector<DataFacts> all = data_facts(problem);
    REQUIRE(all.size() == 1);
    CHECK(all[0].key == "aero.ground.file");
    CHECK(all[0].file == "k.csv");
    CHECK(all[0].csv.rows == 3);
    CHECK(all[0].csv.decimal_sign == ',');
}

TEST_CASE("Names of columns tell their units") {
    CHECK(unit_of_column("z_over_r") == "rotor radii");
    CHECK(unit_of_column("D_OVER_R") == "rotor radii");
    CHECK(unit_of_column("tilt_deg") == "deg");
    CHECK(unit_of_column("x_m") == "m");
    CHECK(unit_of_column("Points_2") == "m");
    CHECK(unit_of_column("factor") == "1");
    CHECK(unit_of_column("force_over_thrust") == "1");
}
