#pragma once

#include <CLI/CLI.hpp>
#include <ctime>
#include <functional>
#include <string>

namespace downwash::bench {

/// Processor time by one of the system's clocks [s]: that of the calling thread unless told.
double processor_time_s(clockid_t clock = CLOCK_THREAD_CPUTIME_ID);

/// The memory of this process [bytes]; negative where the system does not say.
double memory_bytes();

/// The minimum processor time of the calling thread over so many repetitions [s]. Other programs on the machine can
/// only add to it, by emptying caches.
double best_of(int repetitions, const std::function<void()>& work);

/// How much the memory of this process grows during work, at most [bytes]; negative where the system does not say.
double peak_growth_bytes(const std::function<void()>& work);

/// Takes a result, so that no compiler leaves out its computation.
void keep(double result);

/// Empties the processor's caches by reading more memory than they hold.
void empty_caches();

/// A row of a table of bounds, as bench/bars.sh reads it.
void print_bound(const std::string& bound, const std::string& found, bool is_kept);

/// What main() of a measuring program does: reads the command line, works, and reports errors.
/// @return the exit code
int run_program(CLI::App& program, int argc, char** argv, const std::function<void()>& work);

}  // namespace downwash::bench
