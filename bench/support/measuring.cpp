#include "measuring.hpp"

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace downwash::bench {
namespace {

/// A line of /proc/self/status, which counts in kB; negative when it is not there.
double status_bytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        if (word == key + ":") {
            double kilobytes = -1;
            status >> kilobytes;
            return 1024 * kilobytes;
        }
    }
    return -1;
}

volatile double kept = 0;

}  // namespace

double processor_time_s(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double memory_bytes() {
    return status_bytes("VmRSS");
}

double best_of(int repetitions, const std::function<void()>& work) {
    double best_s = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repetitions; ++i) {
        const double start_s = processor_time_s();
        work();
        best_s = std::min(best_s, processor_time_s() - start_s);
    }
    return best_s;
}

double peak_growth_bytes(const std::function<void()>& work) {
    malloc_trim(0);
    std::ofstream clear("/proc/self/clear_refs");
    clear << "5" << std::flush;  // the peak begins anew
    const bool is_clear = clear.good();
    const double before = memory_bytes();
    work();
    const double peak = status_bytes("VmHWM");
    return is_clear && before > 0 && peak > 0 ? peak - before : -1;
}

void keep(double result) {
    kept = result;
}

void empty_caches() {
    static std::vector<unsigned char> memory(std::size_t{1} << 27);
    for (std::size_t i = 0; i < memory.size(); i += 64) {
        ++memory[i];
    }
}

void print_bound(const std::string& bound, const std::string& found, bool is_kept) {
    fmt::print("| {} | {} | {} |\n", bound, found, is_kept ? "kept" : "**not kept**");
}

int run_program(CLI::App& program, int argc, char** argv, const std::function<void()>& work) {
    CLI11_PARSE(program, argc, argv);
    try {
        work();
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
    return 0;
}

}  // namespace downwash::bench
