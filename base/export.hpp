#pragma once

#include <downwash/standard_library.hpp>

/// Marks what a shared library of Downwash exports; all other symbols are hidden.
#define DOWNWASH_EXPORT __attribute__((visibility("default")))
