#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "downwash/effects/measurements.hpp"
#include "downwash/effects/rotor_layout.hpp"

namespace downwash::cli {

/// What --surface takes.
inline constexpr std::array<std::string_view, 2> measured_surfaces{"ground", "ceiling"};

/// Which measurements a command is about: a file, narrowed down by options, and the rotors they were made with.
struct MeasuredData {
    std::string file, surface, source;
    std::optional<double> from, to;  ///< z/R
    std::optional<double> rotor_spacing;

    /// Adds DATA and the options to a command.
    void add_options(CLI::App& command);

    /// @throws InputError, UsageError when nothing is left
    [[nodiscard]] Measurements read() const;

    /// @throws UsageError
    [[nodiscard]] RotorNeighbours neighbours() const;
};

}  // namespace downwash::cli
