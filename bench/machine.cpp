#include "downwash/bench/machine.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <thread>

#include "downwash/base/text.hpp"
#include "source_commit.hpp"  // written by cmake/source_commit.cmake with every build

namespace downwash::bench {

std::string_view source_commit() {
    return DOWNWASH_SOURCE_COMMIT;
}

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

std::string processor() {
    std::string model = "unknown processor";
    std::ifstream description("/proc/cpuinfo");
    for (std::string line; std::getline(description, line);) {
        const std::size_t colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos) {
            model = trimmed(std::string_view(line).substr(colon + 1));
            break;
        }
    }
    return model + ", " + std::to_string(processor_count()) + " processors";
}

unsigned processor_count() {
    return std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace downwash::bench
