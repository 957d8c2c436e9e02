#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>

namespace downwash::cli {

/// Makes shells offer words after an option. Whoever reads the option still checks it.
void offer_words(CLI::Option& option, std::span<const std::string_view> words);

/// Makes an option take only these words, which stand for its type and are offered.
void require_one_of(CLI::Option& option, std::span<const std::string_view> words);

/// A script that completes the program's command line in a shell: "bash" or "zsh".
[[nodiscard]] std::string completion_script(const CLI::App& program, const std::string& shell);

}  // namespace downwash::cli
