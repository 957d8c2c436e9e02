#include <catch2/catch.hpp>
#include <filesystem>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

namespace fs = std::filesystem;

/// A few iterations of the aerodynamics-aware search, and what it wrote.
std::string trajectory_of(const ScratchFolder& folder, const std::vector<std::string>& options = {},
                          const Environment& environment = {}) {
    fs::remove_all(folder / "run/out");
    std::vector<std::string> arguments{"solve",
                                       problem_file("bridge_inspection"),
                                       "--variant",
                                       "mp-arm-ada",
                                       "--seed",
                                       "3",
                                       "--max-iterations",
                                       "25",
                                       "--out",
                                       "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Result result = run(folder, arguments, environment);
    CHECK(result.code <= 1);
    return read_file(folder / "run/out/trajectory.csv");
}

std::string query(const ScratchFolder& folder, const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments{"aeromap", "query", problem_file("bridge_inspection"), "--at", "-3",
                                       "0.32",    "9.6"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Result result = run(folder, arguments);
    CHECK(result.code == 0);
    return result.out;
}

fs::path only_file_in(const fs::path& folder) {
    REQUIRE(fs::is_directory(folder));
    REQUIRE(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    return fs::directory_iterator(folder)->path();
}

}  // namespace

TEST_CASE("Solve keeps its map, uses it again and does not trust a damaged one") {
    const ScratchFolder folder;
    const std::string without = trajectory_of(folder, {"--no-cache"});
    REQUIRE(without.size() > 1000);
    CHECK_FALSE(fs::exists(folder / "cache"));

    CHECK(trajectory_of(folder) == without);
    const fs::path map = only_file_in(folder / "cache/downwash");
    const std::string good = read_file(map);

    // A file that is only read keeps its identity, one that is written anew gets another.
    fs::create_hard_link(map, folder / "same");
    CHECK(trajectory_of(folder) == without);
    CHECK(fs::equivalent(map, folder / "same"));

    std::string damaged = good;
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
    for (const std::string& bad : {damaged, good.substr(0, good.size() / 2), std::string()}) {
        write_file(map, bad);
        CHECK(trajectory_of(folder) == without);
        CHECK(read_file(only_file_in(folder / "cache/downwash")) == good);
    }
}

TEST_CASE("A cache that cannot be written is no cache and no error") {
    const ScratchFolder folder;
    const std::string without = trajectory_of(folder, {"--no-cache"});
    write_file(folder / "file", "in the way");
    CHECK(trajectory_of(folder, {}, {{"XDG_CACHE_HOME", folder / "file"}}) == without);
    CHECK(trajectory_of(folder, {}, {{"XDG_CACHE_HOME", "/proc/nowhere"}}) == without);
    CHECK(trajectory_of(folder, {}, {{"XDG_CACHE_HOME", ""}, {"HOME", ""}}) == without);
    CHECK_FALSE(fs::exists(folder / "cache"));
}

TEST_CASE("Without XDG_CACHE_HOME maps are kept below the home folder") {
    const ScratchFolder folder;
    const std::string home = folder / "home";
    static_cast<void>(trajectory_of(folder, {}, {{"XDG_CACHE_HOME", "relative/path"}, {"HOME", home}}));
    CHECK(only_file_in(home + "/.cache/downwash").extension() == ".aeromap");
    CHECK_FALSE(fs::exists(folder / "run/relative"));
}

TEST_CASE("Queries use the maps of earlier runs, and the flights of other variants none") {
    const ScratchFolder folder;
    const std::string without = query(folder, {"--no-cache"});
    CHECK_FALSE(fs::exists(folder / "cache"));
    CHECK(query(folder) == without);
    const fs::path map = only_file_in(folder / "cache/downwash");
    fs::create_hard_link(map, folder / "same");
    CHECK(query(folder) == without);
    CHECK(fs::equivalent(map, folder / "same"));
    fs::remove_all(folder / "cache");
    const Result result = run(folder, {"solve", problem_file("bridge_inspection"), "--variant", "mp-arm-da",
                                       "--max-iterations", "5", "--json"});
    CHECK(result.json().at("planning").at("map_wall_s") == 0);
}

TEST_CASE("The page of a plan that is flown again keeps its map, unless that is not wanted") {
    const ScratchFolder folder;
    const std::string problem = problem_file("bridge_inspection");
    REQUIRE(run(folder, {"solve", problem, "--max-iterations", "200", "--no-cache", "--out", "out"}).code == 0);
    std::vector<std::string> again{"execute", problem, "--plan", "out/solution.json", "--out", "again"};
    CHECK(run(folder, again).code == 0);
    CHECK(fs::exists(folder / "cache") == (files_of_a_run == 5));
    fs::remove_all(folder / "cache");
    again.emplace_back("--no-cache");
    CHECK(run(folder, again).code == 0);
    CHECK_FALSE(fs::exists(folder / "cache"));
}
