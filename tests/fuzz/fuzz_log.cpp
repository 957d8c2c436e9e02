#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/logs/flight_log.hpp"
#include "downwash/logs/log_reader.hpp"

/// Whatever is read as a flight log has series of finite numbers at rising times, with z up or down.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace downwash;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    LogOptions options;
    options.allows_truncation = size % 2 == 1;
    try {
        const FlightLog log = read_flight_log(bytes, "flight", options);
        for (const NamedSeries& each : named_series) {
            const LogSeries& series = log.*each.series;
            if (series.numbers.size() != series.rows() * series.width) {
                std::abort();
            }
            for (std::size_t i = 0; i < series.rows(); ++i) {
                for (const double number : series.row(i)) {
                    if (!std::isfinite(number) || (i > 0 && !(series.t_s[i] > series.t_s[i - 1]))) {
                        std::abort();
                    }
                }
            }
        }
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
