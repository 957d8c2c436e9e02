#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "../support/error_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/solved_run.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/results/run_record.hpp"

using namespace downwash;
using test::SolvedRun;

namespace {

/// The first error of an action; empty without one.
template <class Action>
std::string first_error_of(const Action& action) {
    const std::vector<KeyError> errors = test::errors_of(action);
    return errors.empty() ? "" : errors[0].message;
}

/// What reading the run says.
std::string error_of(const SolvedRun& run) {
    return first_error_of([&run] { return read_run(run.folder()); });
}

std::string content_of(const std::filesystem::path& file) {
    return read_file(file, 1U << 30U);
}

std::string table_error(const std::string& text) {
    return first_error_of([&text] { return read_number_table(text, "file.csv", {"a", "b"}); });
}

void check_same(const RunRecord& read, const RunRecord& record) {
    CHECK(record.problem.name == read.problem.name);
    CHECK(record.status == read.status);
    CHECK(record.outcome == read.outcome);
    CHECK(record.flight.names == read.flight.names);
    CHECK(record.flight.columns == read.flight.columns);
    CHECK(record.flight.lines == read.flight.lines);
    CHECK(record.tree.names == read.tree.names);
    REQUIRE(record.tree.rows() == read.tree.rows());
    for (std::size_t row = 0; row < record.tree.rows(); ++row) {
        for (std::size_t column = 0; column < record.tree.columns.size(); ++column) {
            const double value = record.tree.columns[column][row];  // NaN, the parent of a root, equals nothing
            REQUIRE((value == read.tree.columns[column][row] ||
                     (std::isnan(value) && std::isnan(read.tree.columns[column][row]))));
        }
    }
    REQUIRE(record.plan);
    REQUIRE(read.plan);
    CHECK(test::same_bytes(*record.plan, *read.plan));
}

}  // namespace

TEST_CASE("a run is read back as it was written, and as its record in memory") {
    const SolvedRun run;
    const RunRecord record = read_run(run.folder());
    CHECK(record.problem.name == run.problem.name);
    CHECK(record.solution_text == content_of(run.file("solution.json")));
    CHECK(record.problem_text == content_of(run.file("effective.yaml")));
    const auto& rows = run.solution.execution->rows;
    REQUIRE(record.flight.rows() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        REQUIRE(record.flight.find("x_m")->at(i) == rows[i].q[0]);
        REQUIRE(record.flight.find("energy_j")->at(i) == rows[i].energy_j);
        REQUIRE(record.flight.find("rotor_1_aero_factor")->at(i) == rows[i].rotor_factor[0]);
    }
    REQUIRE(record.tree.rows() == run.solution.tree.size());
    CHECK(std::isnan(record.tree.find("parent")->at(0)));
    CHECK(record.tree.find("parent")->at(1) == run.solution.tree[1].parent);
    CHECK(record.tree.find("arm_rad")->at(1) == run.solution.tree[1].at[plane::arm]);
    check_same(record, run_record(run.problem, run.solution, *run.solution.execution));  // the record in memory
}

TEST_CASE("files of two runs in one folder are no run, whichever of them is the other's") {
    const SolvedRun run;
    Problem elsewhere = test::ceiling_problem();
    elsewhere.goal = test::tip_goal(2, 4.7);
    const SolvedRun other(elsewhere);
    for (const char* name : {"effective.yaml", "trajectory.csv", "tree.csv", "solution.json"}) {
        CAPTURE(name);
        const std::string own = content_of(run.file(name));
        write_file(run.file(name), content_of(other.file(name)));
        CHECK_THAT(error_of(run), Catch::Contains("solution.json beside it"));
        CHECK_THAT(first_error_of([&run] { return require_whole_run(run.folder()), 0; }),
                   Catch::Contains("solution.json beside it"));
        write_file(run.file(name), own);
    }
    CHECK(error_of(run).empty());
    for (const char* name : {"effective.yaml", "trajectory.csv", "tree.csv"}) {  // a plan may be alone
        CHECK_NOTHROW(require_whole_run(run.folder()));
        std::filesystem::remove(run.file(name));
    }
    CHECK_NOTHROW(require_whole_run(run.folder()));
}

TEST_CASE("a folder tells which problem its run solves") {
    const SolvedRun run;
    const ProblemReference problem = problem_of_solution(run.folder() / "solution.json");
    CHECK(problem.name == run.problem.name);
    CHECK(problem.file == "problem.yaml");
    CHECK(problem.sha256 == problem_sha256(run.problem));
    write_file(run.file("solution.json"), R"({"schema": "downwash/solution/v1", "plan": null})");
    CHECK(problem_of_solution(run.folder() / "solution.json").sha256.empty());
    write_file(run.file("solution.json"), "{}");
    CHECK_THROWS_AS(problem_of_solution(run.folder() / "solution.json"), InputError);
}

TEST_CASE("files that no run left behind are errors with their place") {
    const SolvedRun run;
    SECTION("no folder") {
        CHECK_THROWS_AS(read_run(run.folder() / "elsewhere"), InputError);
    }
    SECTION("a file is missing") {
        std::filesystem::remove(run.file("trajectory.csv"));
        CHECK(error_of(run).find("trajectory.csv cannot be read") != std::string::npos);
    }
    SECTION("a tree may be missing") {
        std::filesystem::remove(run.file("tree.csv"));
        CHECK(read_run(run.folder()).tree.rows() == 0);
    }
    SECTION("files with other content") {
        struct Wrong {
            std::string name, file, content, error;
        };
        const std::string flight = content_of(run.file("trajectory.csv"));
        const std::size_t second_row = flight.find('\n', flight.find('\n') + 1) + 1;
        const std::string before = flight.substr(0, second_row);
        const std::string after_time = flight.substr(flight.find(',', second_row));
        for (const auto& [name, file, content, error] : {
                 Wrong{"no JSON", "solution.json", "{\"schema\": ", "solution.json: this is not the JSON"},
                 {"brackets without end", "solution.json", std::string(100000, '['),
                  "solution.json: this is not the JSON"},
                 {"another schema", "solution.json", R"({"schema": "downwash/solution/v9"})",
                  "its schema is not downwash/solution/v1"},
                 {"a cell too many", "trajectory.csv", before + "0.01," + after_time, "trajectory.csv:3: "},
                 {"time that stands still", "trajectory.csv", before + "0" + after_time, "trajectory.csv:3: t_s is 0"},
                 {"a tree that bites its tail", "tree.csv", "x_m,z_m,arm_rad,parent\n\n0,0,0,1\n1,1,0,0\n",
                  "tree.csv:3: its parents run in a circle"},
                 {"parents that are not there", "tree.csv", "x_m,z_m,arm_rad,parent\n0,0,0,\n1,1,0,7\n",
                  "tree.csv:3: parent is 7"},
             }) {
            CAPTURE(name);
            const std::string sound = content_of(run.file(file));
            write_file(run.file(file), content);
            CHECK_THAT(error_of(run), Catch::Contains(error));
            write_file(run.file(file), sound);
        }
        CHECK(error_of(run).empty());
    }
}

TEST_CASE("tables of numbers are read strictly") {
    const NumberTable table = read_number_table("a,b,c\n1,,-2.5e3\n", "file.csv", {"a", "b"});
    CHECK(table.rows() == 1);
    CHECK(table.find("a")->at(0) == 1);
    CHECK(std::isnan(table.find("b")->at(0)));
    CHECK(table.find("c")->at(0) == -2500);
    CHECK(table.find("d") == nullptr);
    CHECK(read_number_table("a,b\n", "file.csv", {"a", "b"}).rows() == 0);

    CHECK(table_error("") == "file.csv: holds no table: expected a line with the names of its columns, then rows");
    CHECK(table_error("a,b,<c>\n") == "file.csv:1:5: '<c>' is no name of a column: expected letters, digits and '_'");
    CHECK(table_error("a,c\n") == "file.csv:1: there is no column 'b'");
    CHECK(table_error("a,b,a\n") == "file.csv:1:5: the column 'a' occurs twice");
    CHECK(table_error("a,b\n1,2,3\n") ==
          "file.csv:2: holds 3 cells: expected 2, one for each column of line 1; if its numbers have decimal commas, "
          "separate "
          "the columns by ';' or quote the numbers");
    CHECK(table_error("a,b\n1,2\n1,two\n") == "file.csv:3:3: b is 'two': expected a finite number");
    CHECK(table_error("a,b\n1,nan\n") == "file.csv:2:3: b is 'nan': expected a finite number");
    std::string many = "a,b";
    for (int i = 2; i <= 200; ++i) {
        many += ",c" + std::to_string(i);
    }
    CHECK(table_error(many + "\n").find("more than 200 columns") != std::string::npos);
}
