#pragma once

namespace downwash::cli {

/// The exit codes of the program; part of its contract.
enum class ExitCode : int {
    done = 0,           ///< a plan was found and its own flight was ok, a file is good
    no_solution = 1,    ///< none within the limits, approximate plans included; a campaign misses a target
    bad_input = 2,      ///< a file or the command line cannot be used
    flight_failed = 3,  ///< a plan exists and its flight failed
    interrupted = 130,  ///< after SIGINT, with the best solution so far written
    terminated = 143,   ///< after SIGTERM, the same
};

}  // namespace downwash::cli
