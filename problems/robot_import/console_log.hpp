#pragma once

#include <console_bridge/console.h>

#include <string>

namespace downwash::robot_import {

/// Collects what liburdfdom has to say, which it would print.
class ConsoleLog : public console_bridge::OutputHandler {
 public:
    ConsoleLog() { console_bridge::useOutputHandler(this); }
    ~ConsoleLog() override { console_bridge::restorePreviousOutputHandler(); }
    ConsoleLog(const ConsoleLog&) = delete;
    ConsoleLog& operator=(const ConsoleLog&) = delete;

    void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
        if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
            said_ += (said_.empty() ? "" : "; ") + text;
        }
    }
    [[nodiscard]] const std::string& said() const noexcept { return said_; }

 private:
    std::string said_;
};

}  // namespace downwash::robot_import
