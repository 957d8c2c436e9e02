#include "downwash/bench/machine.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "downwash/base/text.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "source_commit.hpp"  // written by cmake/source_commit.cmake with every build

namespace downwash::bench {
namespace {

std::string_view name_of(Instructions set) {
    constexpr std::array<std::string_view, 3> names{"baseline", "avx2", "avx512"};
    return names.at(static_cast<std::size_t>(set));
}

}  // namespace

std::string_view source_commit() {
    return DOWNWASH_SOURCE_COMMIT;
}

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

std::string processor_model() {
    std::string model = "unknown processor";
    std::ifstream description("/proc/cpuinfo");
    for (std::string line; std::getline(description, line);) {
        const std::size_t colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos) {
            model = trimmed(std::string_view(line).substr(colon + 1));
            break;
        }
    }
    return model;
}

std::string processor() {
    return processor_model() + ", " + std::to_string(processor_count()) + " processors";
}

unsigned processor_count() {
    return std::max(1U, std::thread::hardware_concurrency());
}

const Machine& this_machine() {
    static const Machine machine{host_name(), processor_model(), std::string(name_of(best_instructions()))};
    return machine;
}

double system_load() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace downwash::bench
