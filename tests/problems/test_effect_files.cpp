#include <string>

#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/pipe_table.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view ground = "{model: cheeseman-bennett}";
constexpr std::string_view models =
    "  ground: {model: cheeseman-bennett}\n  ceiling: {model: sanchez-cuevas, k1: 6.9}\n";

/// K = 1.25 wherever a rotor of the sound problem can get.
std::string grid_csv(const std::string& lowest_x) {
    return "x_m,z_m,factor\n" + lowest_x + ",0,1.25\n" + lowest_x + ",6,1.25\n7,0,1.25\n7,6,1.25\n";
}

/// What is written into another folder reads as the same problem.
void check_written_elsewhere(const TestFolder& folder, const Problem& problem) {
    std::filesystem::create_directory(folder / "out");
    folder.write("out/effective.yaml", effective_yaml(problem, folder / "out"));
    CHECK(problem_sha256(read_problem(folder / "out/effective.yaml")) == problem_sha256(problem));
}

/// The errors with a file of factors in place of the models.
std::string errors_with_map(const TestFolder& folder, const std::string& csv) {
    folder.write("map.csv", csv);
    return errors_after(folder, models, "  map: map.csv\n");
}

}  // namespace

TEST_CASE("a measured table is read from beside its problem") {
    const TestFolder folder;
    folder.write("tilted.csv", "# ten degrees\nz_over_r,factor\n0.5,1.2\n1,1.05\n2,0.98\n4,1\n");
    const Problem problem = folder.read(edited(good_problem, ground, "{model: table, file: tilted.csv}"));
    CHECK(problem.aero.ground.model == EffectModel::table);
    REQUIRE(problem.aero.ground.table);
    CHECK(problem.aero.ground.table->at()(2) == 0.98);
    CHECK(!problem.aero.ground.d_over_r);
    const auto model = make_flight_model(problem);
    CHECK(model->direct_factor(0, -4, 2 * 0.19) == Approx(0.98));

    check_written_elsewhere(folder, problem);

    // The content counts, not the place.
    folder.write("tilted.csv", "z_over_r,factor\n0.5,1.2\n1,1.05\n2,0.97\n4,1\n");
    CHECK(problem_sha256(read_problem(folder / "problem.yaml")) != problem_sha256(problem));
}

TEST_CASE("a table that is missing, broken or out of place is an error where it is named") {
    const TestFolder folder;
    folder.write("broken.csv", "z_over_r,factor\n0.5,1.2\n1,-3\n");
    folder.write("good.csv", "z_over_r,factor\n0.5,1.2\n1,1.1\n");
    CHECK(errors_after(folder, ground, "{model: table}") ==
          "problem.yaml:10:3: aero.ground.file is missing: expected the file of the table");
    CHECK_THAT(errors_after(folder, ground, "{model: table, file: nowhere.csv}"),
               Catch::StartsWith("problem.yaml:10:32: aero.ground.file"));
    CHECK_THAT(errors_after(folder, ground, "{model: table, file: broken.csv}"),
               Catch::StartsWith("problem.yaml:10:32: aero.ground.file") && Catch::Contains("broken.csv:3"));
    CHECK(errors_after(folder, ground, "{model: he, file: good.csv}") ==
          "problem.yaml:10:23: aero.ground.file has a meaning only with the model table: remove it");
    CHECK(errors_after(folder, ground, "{model: table, file: good.csv, d_over_r: -1}") ==
          "problem.yaml:10:52: aero.ground.d_over_r is -1: expected a number from 0 to 10000, or null");
    // There is no fountain under a ceiling.
    CHECK(errors_after(folder, "{model: sanchez-cuevas, k1: 6.9}", "{model: multirotor-body}")
              .find("problem.yaml:11:20: aero.ceiling.model is 'multirotor-body': expected one of none, ") == 0);
}

TEST_CASE("a grid of factors takes the place of the models, which are errors beside it") {
    const TestFolder folder;
    folder.write("map.csv", grid_csv("-7"));
    const Problem problem = folder.read(edited(good_problem, models, "  map: map.csv\n"));
    REQUIRE(problem.aero.map);
    const auto model = make_flight_model(problem);
    CHECK(model->direct_factor(0, 0, 2) == Approx(1.25));
    CHECK(model->make_map(problem.bounds)->factor(model->rotor_layer(1), 1.3, 2.2) == Approx(1.25).epsilon(1e-6));
    check_written_elsewhere(folder, problem);
    CHECK(errors_after(folder, ground, "{model: he}\n  map: map.csv") ==
          "problem.yaml:10:3: aero.ground has a meaning only without aero.map: remove it\n"
          "problem.yaml:12:3: aero.ceiling has a meaning only without aero.map: remove it");
}

TEST_CASE("a grid that does not fit its problem is an error") {
    const TestFolder folder;
    const std::string said = errors_with_map(folder, grid_csv("-5"));
    CHECK_THAT(said, Catch::StartsWith("problem.yaml:10:8: aero.map does not reach the world point (-6.3, 0.3, 0.2)") &&
                         Catch::Contains("-6.3 to 6.3 m along the plane"));
    // One of other rotors.
    const auto errors_with = [&](const std::string& radius) {
        return errors_with_map(folder, "# rotor_radius_m: " + radius + "\n" + grid_csv("-7"));
    };
    CHECK(errors_with("0.2") ==
          "problem.yaml:10:8: aero.map is of rotors of 0.2 m radius, as its rotor_radius_m says: expected "
          "robot.rotors.radius_m, 0.19 m");
    CHECK(errors_with("0.190001") != "sound");
    for (const char* radius : {"0.1900001", "0.19", "about 8 inches"}) {
        CHECK(errors_with(radius) == "sound");
    }
    // A planar one in another vertical plane.
    const std::string heading = "# frame_heading_rad: ";
    const std::string sixty_degrees = "1.0471975511965976";
    CHECK(errors_with_map(folder, heading + sixty_degrees + "\n" + grid_csv("-7")) ==
          "problem.yaml:10:8: aero.map stands in another vertical plane (60 deg): expected the heading of "
          "environment.plane (0 deg)");
    // Turned by 180 degrees it is the same plane; sideways it may stand anywhere.
    CHECK(errors_with_map(folder, heading + "3.141592653589793\n# frame_origin_m: 0 5 0\n" + grid_csv("-7")) ==
          "sound");
    // A volume may stand in any way.
    std::string volume = heading + sixty_degrees + "\nx_m,y_m,z_m,factor\n";
    for (const char* node : {"-9,-9,0", "9,-9,0", "-9,9,0", "9,9,0", "-9,-9,6", "9,-9,6", "-9,9,6", "9,9,6"}) {
        volume += std::string(node) + ",1.25\n";
    }
    CHECK(errors_with_map(folder, volume) == "sound");
}

TEST_CASE("a table measured over a pipe is turned into one of points, and read alike whatever the order of its keys") {
    const TestFolder folder;
    folder.write("pipe.csv", "z_over_r,factor\n0.4,1.25\n1,1.06\n2,1\n");
    const Problem problem =
        folder.read(edited(good_problem, ground, "{model: table, pipe_radii: 0.5, file: pipe.csv}"));
    REQUIRE(problem.aero.ground.table);
    CHECK(problem.aero.ground.pipe_radii == 0.5);
    CHECK(mean_over_pipe(problem.aero.ground.table->at(), 0.5, 0.4) == Approx(1.25).margin(1e-8));
    CHECK(problem.aero.ground.table->factors()[0] > 1.4);
    check_written_elsewhere(folder, problem);
    CHECK_THAT(errors_after(folder, ground, "{model: table, file: pipe.csv, pipe_radii: 0.001}"),
               Catch::Contains("pipe_radii"));
    folder.write("strong.csv", "z_over_r,factor\n0.4,60\n1,1.06\n2,1\n");
    CHECK_THAT(errors_after(folder, ground, "{model: table, file: strong.csv, pipe_radii: 0.1}"),
               Catch::Contains("is the table of this pipe?"));
}

TEST_CASE("the shipped tables say what they were made from: K falls below one near two radii beside a wall") {
    const auto corner = read_effect_table(DOWNWASH_PROBLEMS "/tables/ground_beside_wall.csv");
    CHECK(corner->at(1.2)(2) < 1);
    CHECK(corner->at(1.2)(1.2) > 1);
    for (const double z_over_r : {0.5, 0.8, 1.2, 2.0, 4.0}) {
        const double images = 1 / (16 * z_over_r * z_over_r);
        CHECK(corner->at(4)(z_over_r) == Approx(1 / (1 - images)).margin(6e-4));
    }
    const auto tandem = read_effect_table(DOWNWASH_PROBLEMS "/tables/tandem_rotors.csv");
    for (double z_over_r = 0.5; z_over_r < 4; z_over_r += 0.05) {
        CHECK(tandem->at()(1.5) <= tandem->at()(z_over_r));
    }
    CHECK(tandem->at()(0.8) > 1);
}
