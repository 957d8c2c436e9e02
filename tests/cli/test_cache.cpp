#include <catch2/catch.hpp>
#include <filesystem>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

namespace fs = std::filesystem;

/// A few iterations of the aerodynamics-aware search, and what it wrote. On one thread: which blocks of a map several
/// threads fill ahead depends on who waits for whom.
std::string trajectory_of(const Workspace& work, const char* options = "", const Environment& environment = {}) {
    fs::remove_all(work.in_run("out"));
    const Result result =
        work.run_in(environment, "",
                    words("solve", problem_file("bridge_inspection"),
                          "--variant mp-arm-ada --seed 3 --max-iterations 25 --threads 1 --out out", options));
    CHECK(result.code <= 1);
    return work.text("out/trajectory.csv");
}

std::string query(const Workspace& work, const char* options = "") {
    return work.succeed("aeromap query", problem_file("bridge_inspection"), "--at -3 0.32 9.6", options).out;
}

fs::path only_file_in(const fs::path& folder) {
    REQUIRE(fs::is_directory(folder));
    REQUIRE(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    return fs::directory_iterator(folder)->path();
}

}  // namespace

TEST_CASE("Solve keeps its map, uses it again and does not trust a damaged one") {
    const Workspace work;
    const std::string without = trajectory_of(work, "--no-cache");
    REQUIRE(without.size() > 1000);
    CHECK_FALSE(fs::exists(work / "cache"));

    CHECK(trajectory_of(work) == without);
    const fs::path map = only_file_in(work / "cache/downwash");
    const std::string good = read_file(map);

    // A file that is only read keeps its identity, one that is written anew gets another.
    fs::create_hard_link(map, work / "same");
    CHECK(trajectory_of(work) == without);
    CHECK(fs::equivalent(map, work / "same"));

    std::string damaged = good;
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
    for (const std::string& bad : {damaged, good.substr(0, good.size() / 2), std::string()}) {
        write_file(map, bad);
        CHECK(trajectory_of(work) == without);
        CHECK(read_file(only_file_in(work / "cache/downwash")) == good);
    }
}

TEST_CASE("A cache that cannot be written is no cache and no error") {
    const Workspace work;
    const std::string without = trajectory_of(work, "--no-cache");
    write_file(work / "file", "in the way");
    CHECK(trajectory_of(work, "", {{"XDG_CACHE_HOME", work / "file"}}) == without);
    CHECK(trajectory_of(work, "", {{"XDG_CACHE_HOME", "/proc/nowhere"}}) == without);
    CHECK(trajectory_of(work, "", {{"XDG_CACHE_HOME", ""}, {"HOME", ""}}) == without);
    CHECK_FALSE(fs::exists(work / "cache"));
    // Without a usable XDG_CACHE_HOME maps are kept below the home folder.
    const fs::path home = work / "home";
    static_cast<void>(trajectory_of(work, "", {{"XDG_CACHE_HOME", "relative/path"}, {"HOME", home}}));
    CHECK(only_file_in(home / ".cache/downwash").extension() == ".aeromap");
    CHECK_FALSE(fs::exists(work.in_run("relative")));
}

TEST_CASE("Queries use the maps of earlier runs") {
    const Workspace work;
    const std::string without = query(work, "--no-cache");
    CHECK_FALSE(fs::exists(work / "cache"));
    CHECK(query(work) == without);
    const fs::path map = only_file_in(work / "cache/downwash");
    fs::create_hard_link(map, work / "same");
    CHECK(query(work) == without);
    CHECK(fs::equivalent(map, work / "same"));
}

TEST_CASE("Flying and showing a plan again needs no map") {
    const Workspace work;
    const std::string problem = problem_file("bridge_inspection");
    work.succeed("solve", problem, "--max-iterations 200 --no-cache --out out");
    work.succeed("execute", problem, "--plan out --out again");
    work.succeed("validate", problem, "--plan out --out validated");
    if (has_pages) {
        work.succeed("report again -o page.html");
    }
    CHECK_FALSE(fs::exists(work / "cache"));
}
