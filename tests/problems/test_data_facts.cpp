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
    CHECK(grid.csv.used == Names{"x_m", "z_m", "factor"});
    CHECK(grid.csv.others == Names{"pressure"});

    const DataFacts paraview = read(
        "Points:0;Points:1;Points:2;factor\n0;0;0;1\n1;0;0;1,5\n0;0;1;1\n1;0;1;1\n"
        "0;1;0;1\n1;1;0;1,5\n0;1;1;1\n1;1;1;1\n");
    CHECK(paraview.kind == DataKind::grid);
    CHECK(paraview.csv.separator == ';');
    CHECK(paraview.csv.decimal_sign == ',');
    CHECK(paraview.csv.used.front() == "Points:0");

    const DataFacts table = read("z_over_r\tfactor\n0.5\t1.3\n1\t1.1\n2\t1\n");
    CHECK(table.kind == DataKind::effect_table);
    CHECK(table.csv.rows == 3);
    CHECK(table.csv.separator == '\t');

    const DataFacts measured = read("source,z_over_r,thrust_ratio,sigma\nbench,1,1.1,\nbench,2,1.05,\n");
    CHECK(measured.kind == DataKind::measurements);
    CHECK(measured.csv.used == Names{"z_over_r", "thrust_ratio"});
    CHECK(measured.csv.others == Names{"source", "sigma"});  // whose cells are empty

    const DataFacts walls =
        read("distance_over_r force_over_thrust moment_over_thrust_radius\n1.5 0.01 0.02\n2.5 0.005 0.01\n");
    CHECK(walls.kind == DataKind::wall_measurements);
    CHECK(walls.csv.separator == ' ');
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
