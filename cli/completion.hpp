#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace downwash::cli {

/// Makes shells offer words after an option. The value is not checked.
void offer_words(CLI::Option& option, std::span<const std::string_view> words);

/// Restricts an option to these words; they are offered and shown as its type.
void require_one_of(CLI::Option& option, const std::vector<std::string_view>& words);

/// A script that completes the program's command line in a shell: "bash" or "zsh".
[[nodiscard]] std::string completion_script(const CLI::App& program, const std::string& shell);

}  // namespace downwash::cli
