#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace downwash::test {

/// An empty folder that disappears with the test.
class ScratchFolder {
 public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
    std::filesystem::path path_;
};

/// The installed problem of that name.
[[nodiscard]] std::string problem_file(const std::string& name);

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& text);

/// How many files `solve` and `execute` write; the page is one of them where the viewer is built.
inline constexpr bool has_pages = DOWNWASH_HAS_PAGES;
inline constexpr std::size_t files_of_a_run = has_pages ? 5 : 4;

/// Every file below a folder, with its content.
[[nodiscard]] std::map<std::string, std::string> files_in(const std::filesystem::path& folder);

/// What a run of the program left behind.
struct Result {
    int code = -1;  ///< 128 + signal when one ended it
    std::string out;
    std::string err;

    [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Environment variables; an empty value takes one away.
using Environment = std::map<std::string, std::string>;

/// The program, running in a folder. Its cache is `cache` beside that, unless the environment says otherwise.
class Program {
 public:
    /// @param input what it reads from standard input; empty: nothing
    Program(const ScratchFolder& folder, const std::vector<std::string>& arguments, const Environment& environment = {},
            const std::string& input = {});

    void send(int signal) const;
    /// Waits until standard error holds a text, a few seconds at most.
    [[nodiscard]] bool has_said(const std::string& text) const;
    [[nodiscard]] Result wait() const;

 private:
    std::filesystem::path out_, err_;
    pid_t process_;
};

/// Runs the program in a folder to its end.
[[nodiscard]] Result run(const ScratchFolder& folder, const std::vector<std::string>& arguments,
                         const Environment& environment = {}, const std::string& input = {});

}  // namespace downwash::test
