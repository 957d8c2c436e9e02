#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "../support/csv_rows.hpp"
#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Matchers::Contains;

namespace {

/// The open air with such a ground model, in a file.
std::filesystem::path problem_with(const Workspace& work, const std::string& ground) {
    write_file(work / "problem.yaml", problem_text("open_air") + "aero: {ground: {model: " + ground + "}}\n");
    return work / "problem.yaml";
}

}  // namespace

TEST_CASE("A grid built where a fountain pushes the body says that it lacks it") {
    const Workspace work;
    const auto build = [&](const std::string& ground, const char* more = "") {
        return work.run("aeromap build", problem_with(work, ground), "-o", work / "grid.csv", "--step 0.5 --rotor 1",
                        more);
    };
    const std::string line = "# fountain: not contained: the grid holds the factors of rotors\n";
    const Result loud = succeeded(build("multirotor-body"));
    CHECK_THAT(loud.err, Contains("does not contain the fountain that pushes the body"));
    CHECK_THAT(read_file(work / "grid.csv"), Contains(line));
    CHECK(build("multirotor-body", "--quiet").err.empty());
    CHECK_THAT(read_file(work / "grid.csv"), Contains(line));
    CHECK_THAT(build("multirotor-images").err, !Contains("fountain"));
    CHECK_THAT(read_file(work / "grid.csv"), !Contains("fountain"));
}

TEST_CASE("The whole vehicle is written over place and pitch as its formulas say over wide ground") {
    const Workspace work;
    const auto problem = problem_with(work, "cheeseman-bennett");
    write_file(problem, replaced(read_file(problem), "z_m: [1, 10]", "z_m: [0.1, 10]"));
    const Result result =
        work.succeed("aeromap build", problem, "-o", work / "vehicle.csv", "--step 9.9 --pitch-deg -10 0 30 --quiet");
    CHECK(result.err.empty());
    const std::string table = read_file(work / "vehicle.csv");
    CHECK_THAT(table, Contains("# problem: open_air\n"));
    const std::string body = table.substr(table.find("\nx_m,z_m,pitch_deg,") + 1);
    CHECK_THAT(body, Catch::StartsWith("x_m,z_m,pitch_deg,force_factor,pitch_torque_nm,pitch_torque_factor,flyable\n"));
    int rows = 0;
    int not_flyable = 0;
    for (const auto& row : rows_of(body)) {
        const auto number = [&row](const char* column) { return std::stod(row.at(column)); };
        const double z = number("z_m");
        const double pitch = number("pitch_deg") * 3.14159265358979323846 / 180;
        // Hubs 0.32 m in front and behind, 0.06 m above; radius 0.1905 m; the nose goes down with the pitch.
        const double front = z + 0.06 * std::cos(pitch) - 0.32 * std::sin(pitch);
        const double rear = z + 0.06 * std::cos(pitch) + 0.32 * std::sin(pitch);
        CHECK(row.at("flyable") == (std::min(front, rear) >= 0.3 * 0.1905 ? "1" : "0"));
        ++rows;
        if (row.at("flyable") == "0") {
            ++not_flyable;
            for (const char* column : {"force_factor", "pitch_torque_nm", "pitch_torque_factor"}) {
                CHECK(row.at(column).empty());
            }
            continue;
        }
        const auto k = [pitch](double height) {
            const double r = 0.1905 / (4 * height);
            const double level = r * r < 0.5 ? r * r / (1 - r * r) : 1;
            return 1 + level * level / (level + 0.37 * std::sin(pitch) * std::sin(pitch));
        };
        const double weight = 4.95 * 9.80665;
        const double torque = -0.5 * weight * 0.32 * (k(front) - k(rear));
        CHECK(number("force_factor") == Approx(0.5 * (k(front) + k(rear))).epsilon(1e-9));
        CHECK(number("pitch_torque_nm") == Approx(torque).epsilon(1e-8).margin(1e-12));
        CHECK(number("pitch_torque_factor") == Approx(torque / (weight * 0.1905)).epsilon(1e-8).margin(1e-12));
    }
    CHECK(rows == 4 * 2 * 3);
    CHECK(not_flyable == 4);  // low, 30 degrees nose down
}

TEST_CASE("A grid or a table of the vehicle that cannot be written is rejected before it is built") {
    const Workspace work;
    // Neither problem exists: the output comes first.
    check_rejected(work.run("aeromap build nowhere.yaml -o grid.txt"),
                   "downwash: grid.txt ends in '.txt': expected .vti (VTK ImageData) or .csv\n");
    check_rejected(work.run("aeromap build nowhere.yaml -o no/such/folder/grid.vti"),
                   "no/such/folder/grid.vti cannot be written");
    CHECK(work.run("aeromap build nowhere.yaml -o grid.vti").code == 2);
    CHECK(work.files().empty());
    for (const auto& [options, reason] : {std::pair{"-o v.vti --pitch-deg 0", "expected a name that ends in .csv"},
                                          {"-o v.csv --pitch-deg 0 90", "--pitch-deg 90: expected degrees, at most 80"},
                                          {"-o v.csv --pitch-deg 0 --step 0.0001", "choose a larger step"},
                                          {"-o v.vti --step 0.001", "more than the 16777216 that are possible: choose"},
                                          {"-o no/such/v.csv --pitch-deg 0", "no/such/v.csv"},
                                          {"-o v.csv --pitch-deg 0 --rotor 1", "--rotor"}}) {
        check_rejected(work.run("aeromap build", problem_file("open_air"), options), reason);
    }
}

TEST_CASE("Any bytes in a file become JSON that can be read, and every line of errors names the program") {
    const Workspace work;
    write_file(work / "grid.csv", "# note: \xff!\nx_m,z_m,factor\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n");
    CHECK(work.json("aeromap info", work / "grid.csv").at("provenance").at(0).at("value") == "\xc3\xbf!");
    write_file(work / "data.csv", "source,surface,z_over_r,thrust_ratio\nb\xff,ground,0.5,1.3\nb\xff,ground,1,1.1\n");
    CHECK_FALSE(work.json("aeromap compare", work / "data.csv").empty());
    write_file(work.in_run("grid.csv"), "x_m,z_m,factor\n0,0,a\n1,0,b\n");
    check_rejected(work.run("aeromap info grid.csv"),
                   "downwash: grid.csv:2:5: factor is 'a': expected a number from 0 to 100\n"
                   "downwash: grid.csv:3:5: factor is 'b': expected a number from 0 to 100\n");
}

TEST_CASE("Points that are none are rejected") {
    const Workspace work;
    const auto query = [&](const std::filesystem::path& points) {
        return work.run("aeromap query", problem_file("open_air"), "--no-cache --points", points);
    };
    check_rejected(query(work.path()), ": is a directory, expected a file\n");
    write_file(work / "points.txt", "x_m,y_m,z_m\n# nothing\n\n");
    check_rejected(query(work / "points.txt"), ": holds no point, expected lines of three numbers, x_m y_m z_m\n");
    write_file(work / "points.txt", "x_m,y_m,z_m\n0,0,3 # one\n");
    CHECK(query(work / "points.txt").code == 0);
}

TEST_CASE("The ranges of a grid are those where a rotor may fly") {
    const Workspace work;
    const std::string head = "x_m,z_m,factor,flyable\n";
    const Words info = words("aeromap info", work / "grid.csv");
    write_file(work / "grid.csv", head + "0,0,2,0\n1,0,1.5,1\n0,1,1.1,1\n1,1,0.5,0\n");
    CHECK_THAT(work.run(info).out,
               Contains("\nflyable      2 of 4 nodes\n") && Contains("\nfactor       1.1 to 1.5 where flyable\n"));
    const auto json = work.json(info);
    CHECK(json.at("nodes") == 4);
    CHECK(json.at("flyable_nodes") == 2);
    REQUIRE(json.at("fields").size() == 1);
    CHECK(json.at("fields")[0].at("greatest") == 1.5);
    write_file(work / "grid.csv", head + "0,0,2,0\n1,0,1.5,0\n0,1,1.1,0\n1,1,0.5,0\n");
    CHECK_THAT(work.run(info).out, Contains("factor       flyable nowhere"));
    CHECK(work.json(info).at("fields")[0].at("least").is_null());
    write_file(work / "grid.csv", "x_m,z_m,factor\n0,0,2\n1,0,1.5\n0,1,1.1\n1,1,0.5\n");
    CHECK_THAT(work.run(info).out, Contains("\nfactor       0.5 to 2\n"));
}

TEST_CASE("A grid built into a log and onto a link says what it wrote, no hundred percentages, and follows the link") {
    const Workspace work;
    std::filesystem::create_directory(work / "store");
    write_file(work / "store/old.csv", "old");
    std::filesystem::create_symlink("store/old.csv", work / "grid.csv");
    CHECK_THAT(work.succeed("aeromap build", problem_file("open_air"), "-o", work / "grid.csv", "--step 0.5").err,
               !Contains("%") && Contains("nodes"));
    CHECK(std::filesystem::is_symlink(work / "grid.csv"));
    CHECK_THAT(read_file(work / "store/old.csv"), Contains("x_m,"));
}
