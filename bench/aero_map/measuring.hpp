#pragma once

#include <functional>

namespace downwash::bench {

/// Processor time of the calling thread [s].
double thread_time_s();

/// The memory of this process [bytes]; negative where the system does not say.
double memory_bytes();

/// The least processor time of the calling thread over so many repetitions [s]. What else runs on the machine can only
/// add to it, by emptying caches.
double best_of(int repetitions, const std::function<void()>& work);

/// How much the memory of this process grows while it works, at most [bytes]; negative where the system does not say.
double peak_growth_bytes(const std::function<void()>& work);

/// Takes a result, so that no compiler leaves out what it was worked out by.
void keep(double result);

/// Empties the processor's caches, by walking through more memory than they hold.
void empty_caches();

}  // namespace downwash::bench
