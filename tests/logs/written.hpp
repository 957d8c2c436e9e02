#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "../support/log_writers.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/logs/log_reader.hpp"

// Logs of a small flight, written to files and read back.

namespace downwash::test {

/// Two seconds at 50 Hz on a rising curve, with a yaw that turns, a roll and four rotors.
inline LoggedFlight small_flight() {
    LoggedFlight flight;
    for (int i = 0; i <= 100; ++i) {
        const double t = 0.02 * i, yaw = 0.4 * t, roll = 0.1;
        const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2), cr = std::cos(roll / 2), sr = std::sin(roll / 2);
        LoggedMoment moment;
        moment.t_s = t;
        moment.position_m = {0.5 * t, 0.1 * t * t, 1 + 0.3 * t};
        moment.velocity_m_s = {0.5, 0.2 * t, 0.3};
        moment.attitude = {cy * cr, cy * sr, sy * sr, sy * cr};  // Rz(yaw) Rx(roll)
        moment.body_rates_rad_s = {0.01, 0.02, 0.4};
        moment.rotor_n = {4, 5, 6, 7 + t};
        flight.push_back(moment);
    }
    return flight;
}

/// A log in a folder of its own.
class WrittenLog {
 public:
    explicit WrittenLog(const std::string& bytes, const std::string& name = "flight.log") : file_(folder_ / name) {
        std::ofstream(file_, std::ios::binary) << bytes;
    }
    [[nodiscard]] FlightLog read(const LogOptions& options = {}) const { return read_flight_log({file_}, options); }
    [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
    ScratchFolder folder_;
    std::filesystem::path file_;
};

}  // namespace downwash::test
