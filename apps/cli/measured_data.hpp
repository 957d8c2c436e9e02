#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/cli/command_line.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/effects/rotor_layout.hpp"

namespace downwash::cli {

/// The values of --surface.
inline constexpr std::array<std::string_view, 2> measured_surfaces{"ground", "ceiling"};

/// Adds the argument DATA for several files of measurements.
void add_data_files(Command command, std::vector<std::string>& files);

/// Checks that a selected entry occurs in a column. @throws UsageError when it does not
/// @param column also the name of the option that selects   @param entry empty: none is selected
void require_entry(const Measurements& measurements, const std::string& file, const char* column,
                   const std::string& entry);

/// The measurements that a command uses: a file, a selection of its rows, and the rotors they were made with.
struct MeasuredData {
    std::string file, surface, source;
    std::optional<double> from, to;  ///< z/R
    std::optional<double> rotor_spacing;

    /// Adds DATA and the options to a command.
    void add_options(Command command);
    /// The options without DATA.
    void add_selection(Command command);

    /// @throws InputError, UsageError when nothing is left
    [[nodiscard]] Measurements read() const;

    /// Warns of ratios and distances that are likely in another unit; whether there are any.
    [[nodiscard]] bool warn_of(const Measurements& measurements) const;

    /// @throws UsageError
    [[nodiscard]] RotorNeighbours neighbours() const;
};

}  // namespace downwash::cli
