#pragma once

/// Marks what a shared library of downwash offers to its users; everything else stays hidden inside.
#define DOWNWASH_EXPORT __attribute__((visibility("default")))
