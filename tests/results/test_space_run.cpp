#include <catch2/catch.hpp>
#include <string>

#include "../support/error_of.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/results/run_folder.hpp"
#include "downwash/results/run_record.hpp"

// The folder of a flight in space.

using namespace downwash;
using Catch::Contains;

namespace {

constexpr char girder[] = DOWNWASH_PROBLEMS "/space/around_a_girder.yaml";

/// A short flight, written into a folder.
struct FlownRun {
    test::ScratchFolder scratch;
    SpaceProblem problem = read_space_problem(girder);
    SpaceSolution solution;
    SpaceRunRecord record;

    FlownRun() {
        solution.algorithm = problem.planner.algorithm;
        SpaceConfigurationGoal here;
        here.x_m = problem.start.position_m[0];
        problem.goals = {{here, 1, {}}};
        SpacePlan plan;
        plan.tick_s = 0.01;
        plan.joints = 3;
        plan.reference.resize(1);
        std::copy(problem.start.position_m.begin(), problem.start.position_m.end(), plan.reference[0].point.position);
        solution.plan = plan;
        solution.execution = SpaceProblemModel(problem).execute(plan);
        record = RunFolder(folder(), problem, girder, false).write(problem, girder, {}, solution);
    }
    [[nodiscard]] std::filesystem::path folder() const { return scratch / "run"; }
    [[nodiscard]] std::string text(const char* name) const { return read_file(folder() / name, 1U << 30U); }
    void edit(const char* name, const std::string& part, const std::string& by) const {
        std::string text = this->text(name);
        const std::size_t at = text.find(part);
        REQUIRE(at != std::string::npos);
        write_file(folder() / name, text.replace(at, part.size(), by));
    }
};

template <class Action>
std::string error_of(const Action& action) {
    const std::vector<KeyError> errors = test::errors_of(action);
    return errors.empty() ? "" : errors[0].message;
}

}  // namespace

TEST_CASE("A run in space is read back as it was written, and as its record in memory") {
    const FlownRun run;
    REQUIRE(run.solution.execution->outcome == Outcome::ok);
    const SpaceRunRecord read = read_space_run(run.folder());
    CHECK(read.solution_text == run.record.solution_text);
    CHECK(read.problem_text == run.record.problem_text);
    CHECK(problem_sha256(read.problem) == problem_sha256(run.problem));
    CHECK(read.status == "solved");
    CHECK(read.outcome == "ok");
    CHECK(read.flight.names == run.record.flight.names);
    CHECK(read.flight.columns == run.record.flight.columns);
    REQUIRE(read.plan);
    CHECK(read.plan->reference.size() == 1);
    CHECK_FALSE(std::filesystem::exists(run.folder() / "tree.csv"));
    require_whole_run(run.folder());
    // Another flight of the same problem may take its place, one of another problem not.
    static_cast<void>(RunFolder(run.folder(), run.problem, "elsewhere.yaml", false));
    SpaceProblem other = run.problem;
    other.start.position_m[2] += 0.1;
    CHECK_THROWS_AS(RunFolder(run.folder(), other, "elsewhere.yaml", false), OtherRunError);
    static_cast<void>(RunFolder(run.folder(), other, "elsewhere.yaml", true));
}

TEST_CASE("What is no run in space is rejected with its place") {
    const FlownRun run;
    SECTION("another trajectory") {
        run.edit("trajectory.csv", "\n0.01,", "\n0.010,");
        CHECK_THAT(error_of([&] { return read_space_run(run.folder()); }),
                   Contains("trajectory.csv") && Contains("not the file"));
        CHECK_THAT(error_of([&] { require_whole_run(run.folder()); }), Contains("trajectory.csv"));
    }
    SECTION("another problem") {
        run.edit("effective.yaml", "around_a_girder", "around_a_pier");
        CHECK_THAT(error_of([&] { return read_space_run(run.folder()); }), Contains("effective.yaml"));
        CHECK_THAT(error_of([&] { require_whole_run(run.folder()); }), Contains("effective.yaml"));
    }
    SECTION("a missing column") {
        run.edit("trajectory.csv", ",qw,", ",quw,");
        CHECK_THAT(error_of([&] { return read_space_run(run.folder()); }), Contains("there is no column 'qw'"));
    }
    SECTION("an empty cell") {
        run.edit("trajectory.csv", "\n0.01,-2", "\n0.01,");
        CHECK_THAT(error_of([&] { return read_space_run(run.folder()); }), Contains("ref_x_m is empty"));
    }
    SECTION("for readers of runs in the plane") {
        CHECK_THAT(error_of([&] { return read_run(run.folder()); }),
                   Contains("effective.yaml: this is a run in space, and one in a vertical plane is expected"));
    }
}
