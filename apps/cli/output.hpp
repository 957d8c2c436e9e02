#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace downwash {
struct LocatedError;
}

namespace downwash::cli {

using Json = nlohmann::ordered_json;

/// Writes text to standard error. If that fails, nothing is said and the exit code still tells.
void print_error(std::string_view text) noexcept;

/// Reports on standard error a key that a file calls by a former name.
void print_outdated(const LocatedError& key) noexcept;

/// Reports on standard error what is likely not meant.
void print_warning(const LocatedError& warning) noexcept;

/// A line of a table with two columns.
[[nodiscard]] std::string table_row(std::string_view name, const std::string& value);

/// A word of a command line, quoted as a shell needs it.
[[nodiscard]] std::string shell_word(const std::string& text);

/// Adds every warning to `warnings`, and prints it unless it is to be quiet.
[[nodiscard]] std::function<void(const LocatedError&)> noting(std::vector<LocatedError>& warnings, bool is_quiet);

/// The same for keys that a file calls by a former name.
[[nodiscard]] std::function<void(const LocatedError&)> noting_outdated(std::vector<LocatedError>& warnings,
                                                                       bool is_quiet);

/// A document as commands print it with --json. Text from files may be any bytes; invalid UTF-8 in it is replaced.
[[nodiscard]] std::string text_of(const Json& document);

/// Prints that text.
void print_json(const Json& document);

/// The number, or null without one.
[[nodiscard]] Json json_of(const std::optional<double>& value);
/// Null for what is not finite.
[[nodiscard]] Json finite(double value);

/// Writes a file that an option names, whole or not at all. @throws UsageError when that fails
/// @param option its name, for messages; empty: none
void write_result(const std::filesystem::path& file, std::string_view content, std::string_view option = {});

/// Names of files in one folder, and their contents.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// Writes files that belong together, one after the other. It first removes all of before but the first one, so that
/// files of two commands never stand side by side, even after a kill. @throws UsageError when that fails
void write_together(const std::filesystem::path& folder, const NamedTexts& files);

/// Checks that write_result() can begin, before anything is computed. @throws UsageError when it cannot
void require_writable_result(const std::filesystem::path& file, std::string_view option);

/// The folder for the results of a command. Files in it appear whole or not at all.
class OutputFolder {
 public:
    /// Makes the folder and checks that files can be written there. @throws UsageError when they cannot
    explicit OutputFolder(std::filesystem::path path);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    /// Writes a file in the folder; see write_result().
    void write(const std::string& name, std::string_view content) const { write_result(path_ / name, content); }

 private:
    std::filesystem::path path_;
};

}  // namespace downwash::cli
