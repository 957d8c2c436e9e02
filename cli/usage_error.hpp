#pragma once

#include <stdexcept>

namespace downwash::cli {

/// The command line asks for something that cannot be done: an option out of range, a folder that cannot be written.
/// Ends the program with ExitCode::bad_input.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace downwash::cli
