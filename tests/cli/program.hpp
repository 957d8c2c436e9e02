#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/scratch_folder.hpp"

namespace downwash::test {

/// The words of a command line.
using Words = std::vector<std::string>;

/// A command line in parts: a literal is split at its blanks, a string or path is one word, a list is its words.
template <class... Parts>
[[nodiscard]] Words words(const Parts&... parts);

/// The shipped problem of that name.
[[nodiscard]] std::string shipped_file(const std::string& name);
/// The same for the ideal robot in the nominal world, in a file of its own.
[[nodiscard]] std::string problem_file(const std::string& name);
/// Its text for a file elsewhere: the robot is named by its absolute path.
[[nodiscard]] std::string problem_text(const std::string& name);
/// The text with its first `part` replaced. Fails the test where there is none.
[[nodiscard]] std::string replaced(std::string text, const std::string& part, const std::string& by);

/// A solution.json for bridge_inspection whose plan leads straight through the walkway.
inline constexpr const char* plan_through_walkway = R"({"schema": "downwash/solution/v1", "plan": {
    "waypoints": [{"x_m": -10, "z_m": 8.5, "arm_rad": 1.5707963267948966}, {"x_m": 2, "z_m": 7, "arm_rad": 0}],
    "reference": [
        {"t_s": 0, "x_m": -10, "z_m": 8.5, "arm_rad": 1.5707963267948966, "vx_m_s": 0, "vz_m_s": 0,
         "arm_rate_rad_s": 0, "ax_m_s2": 0, "az_m_s2": 0, "arm_acceleration_rad_s2": 0},
        {"t_s": 30, "x_m": 2, "z_m": 7, "arm_rad": 0, "vx_m_s": 0, "vz_m_s": 0,
         "arm_rate_rad_s": 0, "ax_m_s2": 0, "az_m_s2": 0, "arm_acceleration_rad_s2": 0}]}})";

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& text);

/// How many files `solve` and `execute` write; the page is one of them where the viewer is built.
inline constexpr bool has_pages = DOWNWASH_HAS_PAGES;
inline constexpr std::size_t files_of_a_run = has_pages ? 5 : 4;

/// What a run of the program left behind.
struct Result {
    int code = -1;  ///< 128 + signal when one ended it
    std::string out;
    std::string err;

    [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// The run itself, after a check that it ended with 0.
Result succeeded(Result result);

/// Checks that a command line was rejected: exit code 2, nothing on standard output, the reason on standard error.
void check_rejected(const Result& result, const std::string& reason);

/// Environment variables; an empty value takes one away.
using Environment = std::map<std::string, std::string>;

/// A folder for one test. The program runs in its subfolder `run`; what a test gives it may stand beside that.
class Workspace : public ScratchFolder {
 public:
    Workspace() { std::filesystem::create_directory(*this / "run"); }

    /// A path within the folder in which the program runs.
    [[nodiscard]] std::filesystem::path in_run(const std::string& name = "") const { return *this / "run" / name; }
    /// The content of a file there.
    [[nodiscard]] std::string text(const std::string& name) const { return read_file(in_run(name)); }
    /// Every file below that folder, or below a folder in it, with its content.
    [[nodiscard]] std::map<std::string, std::string> files(const std::string& below = "") const;

    /// Runs the program to its end; the arguments are those of words().
    template <class... Parts>
    [[nodiscard]] Result run(const Parts&... parts) const {
        return run_in({}, {}, words(parts...));
    }
    /// The same; the test fails where the exit code is not 0.
    template <class... Parts>
    Result succeed(const Parts&... parts) const {
        return succeeded(run(parts...));
    }
    /// The JSON that a run prints, which must end with 0.
    template <class... Parts>
    [[nodiscard]] nlohmann::json json(const Parts&... parts) const {
        return succeed(parts..., "--json").json();
    }
    /// The same with other environment variables and something on standard input.
    [[nodiscard]] Result run_in(const Environment& environment, const std::string& input, const Words& arguments) const;
};

/// The program, running in a workspace. Its cache is `cache` in there, unless the environment says otherwise.
class Program {
 public:
    /// @param input what it reads from standard input; empty: nothing
    Program(const Workspace& work, const Words& arguments, const Environment& environment = {},
            const std::string& input = {});

    void send(int signal) const;
    /// Waits until standard error holds a text, a few seconds at most.
    [[nodiscard]] bool has_said(const std::string& text) const;
    [[nodiscard]] Result wait() const;

 private:
    std::filesystem::path out_, err_;
    pid_t process_;
};

namespace words_of {
void add(Words& all, const char* blank_separated);
inline void add(Words& all, const std::string& word) {
    all.push_back(word);
}
inline void add(Words& all, const std::filesystem::path& path) {
    all.push_back(path.string());
}
inline void add(Words& all, const Words& more) {
    all.insert(all.end(), more.begin(), more.end());
}
}  // namespace words_of

template <class... Parts>
Words words(const Parts&... parts) {
    Words all;
    (words_of::add(all, parts), ...);
    return all;
}

}  // namespace downwash::test
