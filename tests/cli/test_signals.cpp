#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

/// A search that goes on for ten minutes, running as far as it says `text`.
struct LongSearch : Workspace {
    explicit LongSearch(const std::string& text, const std::string& variant = "mp-arm-ada")
        : program(*this, words("solve", problem_file("open_air"), "--time-limit 600 --out x --variant", variant)) {
        REQUIRE(program.has_said(text));
    }

    Program program;
};

}  // namespace

TEST_CASE("A signal in the middle of a search writes the best plan so far") {
    const auto [signal, code] = GENERATE(std::pair(SIGINT, 130), std::pair(SIGTERM, 143));
    const LongSearch work("best planned cost", GENERATE("mp-arm-ada", "mp-arm-da", "mp-arm"));
    work.program.send(signal);
    const Result result = work.program.wait();
    CHECK(result.code == code);
    CHECK_THAT(result.out, Catch::StartsWith("Interrupted. Solved. "));

    const auto files = work.files("x");
    REQUIRE(files.size() == files_of_a_run);
    const auto solution = nlohmann::json::parse(files.at("solution.json"));
    CHECK(solution.at("interrupted") == true);
    CHECK(solution.at("status") == "solved");
    CHECK(solution.at("execution").at("outcome") == "ok");
    CHECK(files.at("trajectory.csv").ends_with("\n"));
}

TEST_CASE("A signal at the very beginning leaves valid files too") {
    const LongSearch work("planning");
    work.program.send(SIGINT);
    CHECK(work.program.wait().code == 130);
    const auto files = work.files("x");
    REQUIRE(files.size() >= 4);  // without an aero map there is no page
    CHECK(nlohmann::json::parse(files.at("solution.json")).at("interrupted") == true);
}

TEST_CASE("Two signals end the program at once and leave no half file") {
    const LongSearch work("planning");
    work.program.send(SIGINT);
    work.program.send(SIGTERM);
    const Result result = work.program.wait();
    CHECK((result.code == 130 || result.code == 143));
    for (const auto& [name, text] : work.files()) {
        CHECK_FALSE(name.ends_with("solution.json"));
    }
}

TEST_CASE("The end of the wall time writes the best plan so far, and is no signal") {
    const Workspace work;
    const Result result = work.run(words("solve", problem_file("open_air"), "--time-limit 600 --wall-limit 5 --out x"));
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Catch::StartsWith("Interrupted. Solved. "));
    CHECK(work.files("x").size() == files_of_a_run);
    const Result at_once = work.run(words("solve", problem_file("open_air"), "--wall-limit 1e-9 --out y"));
    CHECK(at_once.code == 1);
    CHECK_THAT(at_once.err, Catch::Contains("--wall-limit expects more"));
}

TEST_CASE("What grows beyond its memory ends and writes what there is, and is no signal") {
    const Workspace work;
    const auto solved_within = [&](int mib) {
        return work.run(words("solve", problem_file("open_air"), "--time-limit 60 --force --out x --max-memory",
                              std::to_string(mib) + "MiB"));
    };
    int mib = 1;
    Result result = solved_within(mib);
    CHECK(result.code == 1);
    CHECK_THAT(result.err, Catch::Contains("--max-memory expects more"));
    // The least memory with which it has something to write: that is too little for all of the search.
    for (mib = 12; mib < 1000 && result.err.find("expects more") != std::string::npos; mib += 2 + mib / 10) {
        result = solved_within(mib);
    }
    CAPTURE(mib);
    CHECK_THAT(result.out, Catch::StartsWith("Interrupted. "));
    CHECK((result.code == 0 || result.code == 1));
    CHECK(work.files("x").size() >= 2);
    CHECK(work.run(words("solve", problem_file("open_air"), "--max-memory much --out y")).code == 2);
}

namespace {

/// While it lives, no file may grow beyond so many bytes, those of programs started meanwhile included (ulimit -f).
class FileSizeLimit {
 public:
    explicit FileSizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
    rlimit before_{};
};

}  // namespace

TEST_CASE("Files that may not grow are an error with its reason, like a full disk, and leave nothing behind") {
    const Workspace work;
    const Words command = words("solve", problem_file("open_air"), "--max-iterations 20 --no-cache --out x");
    const FileSizeLimit limit(20000);
    const Result result = work.run(command);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Catch::Contains("trajectory.csv cannot be written: File too large"));
    for (const auto& [name, text] : work.files()) {
        CHECK_FALSE(name.ends_with(".part"));
        CHECK_FALSE(name.ends_with("solution.json"));
    }
}

TEST_CASE("Results stand without their page, and the page of before is gone") {
    const Workspace work;
    const Words command =
        words("solve", problem_file("bridge_inspection"), "--variant mp-arm-da --max-iterations 1 --out x");
    REQUIRE(work.run(command).code == 1);  // without a plan every other file is small
    if (has_pages) {
        const FileSizeLimit limit(work.text("x/report.html").size() * 9 / 10);  // its times have other digits next time
        const Result result = work.run(command);
        CHECK(result.code == 1);
        CHECK_THAT(result.out, Catch::StartsWith("No solution within the limits"));
        CHECK_THAT(result.err, Catch::Contains("report.html cannot be written: File too large"));
        CHECK(work.files("x").size() == files_of_a_run - 1);
    }
}

TEST_CASE("Help that cannot be written is an error") {
    const Workspace work;
    const FileSizeLimit limit(0);
    CHECK(work.run("solve --help").code == 2);
    CHECK(work.run("--version").code == 2);
}
