#include "downwash/search/quiet_ompl.hpp"

#include <ompl/util/Console.h>

#include <mutex>

namespace downwash::planning {
namespace {

// OMPL has one log level for the whole process, so concurrent searches share one silence.
std::mutex mutex;
int living = 0;
ompl::msg::LogLevel level_before = ompl::msg::LOG_DEBUG;

}  // namespace

QuietOmpl::QuietOmpl() {
    const std::lock_guard lock(mutex);
    if (living++ == 0) {
        level_before = ompl::msg::getLogLevel();
        ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    }
}

QuietOmpl::~QuietOmpl() {
    const std::lock_guard lock(mutex);
    if (--living == 0) {
        ompl::msg::setLogLevel(level_before);
    }
}

}  // namespace downwash::planning
