#include "downwash/cli/output.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/cli/usage_error.hpp"

#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

/// Runs work on a file; a FileError becomes a UsageError that names the option and the file.
template <class Work>
void with_usage_errors(const fs::path& file, std::string_view option, const Work& work) {
    try {
        work();
    } catch (const FileError& error) {
        throw UsageError("{}{}{} {}", option, option.empty() ? "" : " ", file.string(), error.what());
    }
}

}  // namespace

void print_error(std::string_view text) noexcept {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fflush(stderr));
}

void print_outdated(const LocatedError& key) noexcept {
    print_error(to_text(key) + "\n");
}

void print_warning(const LocatedError& warning) noexcept {
    LocatedError shown = warning;
    shown.message.insert(0, "warning: ");
    print_error(to_text(shown) + "\n");
}

std::string table_row(std::string_view name, const std::string& value) {
    return fmt::format("  {:<16}  {}\n", name, value);
}

std::string shell_word(const std::string& text) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+:@%,=";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) {
        return text;
    }
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return quoted + "'";
}

std::function<void(const LocatedError&)> noting(std::vector<LocatedError>& warnings, bool is_quiet) {
    return [&warnings, is_quiet](const LocatedError& warning) {
        warnings.push_back(warning);
        if (!is_quiet) {
            print_warning(warning);
        }
    };
}

std::function<void(const LocatedError&)> noting_outdated(std::vector<LocatedError>& warnings, bool is_quiet) {
    return [&warnings, is_quiet](const LocatedError& key) {
        warnings.push_back(key);
        if (!is_quiet) {
            print_outdated(key);
        }
    };
}

std::string text_of(const Json& document) {
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_json(const Json& document) {
    fmt::print("{}", text_of(document));
}

Json json_of(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json finite(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

void write_result(const fs::path& file, std::string_view content, std::string_view option) {
    with_usage_errors(file, option, [&] { write_file(file, content); });
}

void write_together(const fs::path& folder, const NamedTexts& files) {
    for (std::size_t i = 1; i < files.size(); ++i) {
        std::error_code ignored;
        fs::remove(folder / files[i].first, ignored);
    }
    for (const auto& [name, content] : files) {
        write_result(folder / name, content);
    }
}

void require_writable_result(const fs::path& file, std::string_view option) {
    with_usage_errors(file, option, [&] { require_writable(file); });
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (!fs::is_directory(path_)) {
        throw UsageError("--out {} cannot be made a folder: {}", path_.string(),
                         error ? error.message() : "it is a file");
    }
    const fs::path trial = path_ / "solution.json";
    try {
        require_writable(trial);
    } catch (const FileError& failure) {
        throw UsageError("{} {}; choose another folder with --out", trial.string(), failure.what());
    }
}

}  // namespace downwash::cli
