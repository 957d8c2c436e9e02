#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace downwash::cli {

/// The command line asks for something that cannot be done: an option out of range, a folder that cannot be written.
/// Ends the program with ExitCode::bad_input.
struct UsageError : std::runtime_error {
    explicit UsageError(const std::string& message) : std::runtime_error(message) {}
    /// With values in place of {}.
    template <class... Values>
    explicit UsageError(fmt::format_string<Values...> message, Values&&... values)
        : UsageError(fmt::format(message, std::forward<Values>(values)...)) {}
};

/// Says that there is no such name and which name was likely meant. @throws UsageError always
/// @param what the name was given to: "--format"   @param known every name that there is
[[noreturn]] void reject_unknown(const std::string& what, std::string_view word,
                                 const std::vector<std::string_view>& known);

/// The names of all entries of a table.
template <class Table>
[[nodiscard]] std::vector<std::string_view> names_of(const Table& table) {
    std::vector<std::string_view> names;
    names.reserve(std::size(table));
    for (const auto& entry : table) {
        names.emplace_back(entry.name);
    }
    return names;
}

/// The entry of a table that has a name. @throws UsageError as reject_unknown() when there is none
template <class Table>
[[nodiscard]] const auto& entry_named(const Table& table, std::string_view name, const std::string& what) {
    const auto found =
        std::find_if(table.begin(), table.end(), [name](const auto& entry) { return entry.name == name; });
    if (found == table.end()) {
        reject_unknown(what, name, names_of(table));
    }
    return *found;
}

}  // namespace downwash::cli
