#pragma once

/// Marks what a shared library of Downwash exports; all other symbols are hidden.
#define DOWNWASH_EXPORT __attribute__((visibility("default")))
