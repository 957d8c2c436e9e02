#include "downwash/logs/ulog_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"
#include "downwash/logs/candidate_series.hpp"
#include "downwash/logs/log_jumps.hpp"
#include "downwash/logs/ulog_formats.hpp"

namespace downwash::logs {
namespace {

constexpr std::size_t header_bytes = 16, message_header_bytes = 3, flag_bytes = 40;
constexpr std::size_t max_rotors_in_log = 32;

/// A topic of PX4, and what a series takes from it.
struct Topic {
    std::string_view message;
    LogSeries FlightLog::*series;
    std::string_view array;                    ///< its numbers, if it stands in one
    std::array<std::string_view, 3> fields{};  ///< those of others
    std::size_t width = 3;                     ///< 0: as many as are in use
    std::array<std::string_view, 2> valid{};   ///< flags without which a row does not count
    RotorUnit rotor_unit = RotorUnit::newton;
};

/// The best one of each series comes first.
const std::array topics{
    Topic{"vehicle_local_position", &FlightLog::position_m, "", {"x", "y", "z"}, 3, {"xy_valid", "z_valid"}},
    Topic{"vehicle_local_position", &FlightLog::velocity_m_s, "", {"vx", "vy", "vz"}, 3, {"v_xy_valid", "v_z_valid"}},
    Topic{"vehicle_odometry", &FlightLog::position_m, "position"},
    Topic{"vehicle_attitude", &FlightLog::attitude, "q", {}, 4},
    Topic{"vehicle_odometry", &FlightLog::attitude, "q", {}, 4},
    Topic{"vehicle_angular_velocity", &FlightLog::body_rates_rad_s, "xyz"},
    Topic{"sensor_combined", &FlightLog::body_rates_rad_s, "gyro_rad"},
    Topic{"vehicle_attitude", &FlightLog::body_rates_rad_s, "", {"rollspeed", "pitchspeed", "yawspeed"}},
    Topic{"sensor_combined", &FlightLog::specific_force_m_s2, "accelerometer_m_s2"},
    Topic{"vehicle_acceleration", &FlightLog::specific_force_m_s2, "xyz"},
    Topic{"actuator_motors", &FlightLog::rotor_commands, "control", {}, 0, {}, RotorUnit::share},
    Topic{"actuator_outputs", &FlightLog::rotor_commands, "output", {}, 0, {}, RotorUnit::microseconds},
    Topic{"trajectory_setpoint", &FlightLog::setpoint_m, "position"},
    Topic{"trajectory_setpoint", &FlightLog::setpoint_m, "", {"x", "y", "z"}},
    Topic{"vehicle_local_position_setpoint", &FlightLog::setpoint_m, "", {"x", "y", "z"}},
};

/// A number of a message.
struct Place {
    NumberType type;
    std::size_t at;
};

/// What of the messages of a subscription goes into which series.
struct Taken {
    CandidateSeries* into;
    std::vector<Place> numbers, valid;
    bool counts_used = false;  ///< the width is as many as are in use
};

/// A counter of resets in the messages of a subscription.
struct Watched {
    ResetWatch* watch;
    Place counter;
    std::vector<Place> delta;
};

struct Subscription {
    std::string message;
    std::size_t bytes = 0;
    Place time{}, sample_time{};
    bool has_sample_time = false;
    std::vector<Taken> taken;
    std::vector<Watched> watched;
};

std::vector<Place> places_of(const ULogField& field, std::size_t count) {
    const std::size_t bytes = field.type == NumberType::f64 ? 8 : 4;
    std::vector<Place> places;
    for (std::size_t i = 0; i < count; ++i) {
        places.push_back({field.type, field.at + i * bytes});
    }
    return places;
}

bool is_real(NumberType type) {
    return type == NumberType::f32 || type == NumberType::f64;
}

class ULog {
 public:
    ULog(LogBytes& bytes, const LogOptions& options) : bytes_(bytes), options_(options) {}

    FlightLog read() {
        read_header();
        while (read_message()) {
        }
        log_.files = {bytes_.name()};
        log_.format = LogFormat::ulog;
        log_.recorded_axes = options_.axes.value_or(LogAxes::down);
        log_.axes_source = options_.axes ? AxesSource::declared : AxesSource::format;
        choose(candidates_, log_);
        for (const ResetWatch& watch : watches_) {
            // A topic that counts all resets together is only asked where it tells the places.
            if (watch.counter().kind != JumpKind::estimator ||
                log_.position_m.source.starts_with(watch.counter().message)) {
                log_.jumps.insert(log_.jumps.end(), watch.jumps().begin(), watch.jumps().end());
            }
        }
        return std::move(log_);
    }

 private:
    [[noreturn]] void fail(const std::string& message) const { bytes_.fail_at(message_at_, message); }

    void read_header() {
        using namespace std::string_view_literals;
        constexpr auto magic = "ULog\x01\x12\x35"sv;
        const std::string_view header = bytes_.peek(header_bytes);
        if (!header.starts_with(magic)) {
            fail("is no ULog: expected the bytes 55 4c 6f 67 01 12 35");
        }
        if (header.size() < header_bytes) {
            fail("the header ends after " + std::to_string(header.size()) + " bytes: expected 16");
        }
        bytes_.skip(header_bytes);
    }

    bool read_message() {
        message_at_ = bytes_.offset();
        const std::string_view header = bytes_.peek(message_header_bytes);
        if (header.empty()) {
            return false;
        }
        std::size_t size = 0;
        std::string_view whole;
        if (header.size() == message_header_bytes) {
            size = number_at<std::uint16_t>(header.data());
            whole = bytes_.peek(message_header_bytes + size);
        }
        if (whole.size() < message_header_bytes + size || header.size() < message_header_bytes) {
            const std::string text = "the log ends within a message";
            if (!options_.allows_truncation) {
                fail(text + "; --allow-truncated reads it up to there");
            }
            log_.remarks.push_back("byte " + std::to_string(message_at_) + ": " + text + ", which is left out");
            return false;
        }
        take(whole[2], whole.substr(message_header_bytes));
        bytes_.skip(whole.size());
        return true;
    }

    void take(char type, std::string_view body) {
        switch (type) {
            case 'B':
                check_flags(body);
                break;
            case 'F':
                if (const std::string error = formats_.add(body); !error.empty()) {
                    fail(error);
                }
                break;
            case 'A':
                subscribe(body);
                break;
            case 'R':
                if (body.size() >= 2) {
                    subscriptions_[number_at<std::uint16_t>(body.data())].reset();
                }
                break;
            case 'D':
                take_data(body);
                break;
            case 'O':
                ++dropouts_;
                break;
            default:  // parameters, texts, information, and what later versions add
                break;
        }
    }

    void check_flags(std::string_view body) const {
        if (body.size() < flag_bytes) {
            fail("the flags are " + std::to_string(body.size()) + " bytes: expected 40");
        }
        constexpr unsigned data_appended = 1;  // further definitions and data follow the first ones
        for (std::size_t i = 8; i < 16; ++i) {
            const unsigned flags = static_cast<unsigned char>(body[i]);
            if ((flags & ~(i == 8 ? data_appended : 0U)) != 0) {
                fail("the log needs a reader of a later version: it sets an incompatible flag");
            }
        }
    }

    void subscribe(std::string_view body) {
        constexpr std::size_t id_bytes = 3;
        if (body.size() <= id_bytes) {
            fail("a subscription of " + std::to_string(body.size()) + " bytes names no message");
        }
        const auto instance = static_cast<unsigned char>(body[0]);
        const auto id = number_at<std::uint16_t>(body.data() + 1);
        const std::string_view name = body.substr(id_bytes);
        const ULogFormats::Layout layout = formats_.layout(name);
        if (!layout.error.empty()) {
            fail("the subscription of '" + excerpt(name) + "': " + layout.error);
        }
        Subscription subscription{std::string(name), layout.bytes, {}, {}, false, {}, {}};
        const auto time = layout.fields.find("timestamp");
        if (instance == 0 && time != layout.fields.end()) {
            subscription.time = {time->second.type, time->second.at};
            if (const auto sample = layout.fields.find("timestamp_sample"); sample != layout.fields.end()) {
                subscription.sample_time = {sample->second.type, sample->second.at};
                subscription.has_sample_time = true;
            }
            for (std::size_t rank = 0; rank < topics.size(); ++rank) {
                if (topics[rank].message == name) {
                    take_topic(rank, layout, subscription);
                }
            }
            for (const ResetCounter& counter : reset_counters) {
                if (counter.message == name) {
                    watch(counter, layout, subscription);
                }
            }
        }
        subscriptions_[id] = std::move(subscription);
    }

    void watch(const ResetCounter& counter, const ULogFormats::Layout& layout, Subscription& subscription) {
        const auto field = layout.fields.find(counter.counter);
        if (field == layout.fields.end()) {
            return;
        }
        auto known =
            std::ranges::find_if(watches_, [&counter](const ResetWatch& each) { return &each.counter() == &counter; });
        if (known == watches_.end()) {
            watches_.emplace_back(counter);
            known = watches_.end() - 1;
        }
        Watched watched{&*known, {field->second.type, field->second.at}, {}};
        const auto delta = layout.fields.find(counter.delta);
        if (delta != layout.fields.end() && delta->second.count >= counter.count && is_real(delta->second.type)) {
            watched.delta = places_of(delta->second, counter.count);
        }
        subscription.watched.push_back(std::move(watched));
    }

    void take_topic(std::size_t rank, const ULogFormats::Layout& layout, Subscription& subscription) {
        const Topic& topic = topics[rank];
        Taken taken{};
        const auto add = [&](std::string_view name, std::size_t count) {
            const auto field = layout.fields.find(name);
            if (field == layout.fields.end() || field->second.count < count) {
                return false;
            }
            const ULogField& found = field->second;
            const std::vector<Place> places =
                places_of(found, count == 0 ? std::min(found.count, max_rotors_in_log) : count);
            taken.numbers.insert(taken.numbers.end(), places.begin(), places.end());
            return is_real(found.type);
        };
        const bool is_there = topic.array.empty()
                                  ? std::ranges::all_of(topic.fields, [&](auto name) { return add(name, 1); })
                                  : add(topic.array, topic.width);
        if (!is_there) {
            return;
        }
        for (const std::string_view name : topic.valid) {
            if (const auto flag = layout.fields.find(name); flag != layout.fields.end()) {
                taken.valid.push_back({flag->second.type, flag->second.at});
            }
        }
        taken.counts_used = topic.width == 0;
        // A log of several parts subscribes again.
        auto known = std::ranges::find_if(
            candidates_, [&](const CandidateSeries& each) { return each.what == topic.series && each.rank == rank; });
        if (known == candidates_.end()) {
            candidates_.emplace_back();
            known = candidates_.end() - 1;
            known->what = topic.series;
            known->rank = rank;
            known->rotor_unit = topic.rotor_unit;
            known->series.width = topic.width;
            known->series.source =
                std::string(topic.message) + (topic.array.empty() ? "" : "." + std::string(topic.array));
        }
        taken.into = &*known;
        subscription.taken.push_back(std::move(taken));
    }

    void take_data(std::string_view body) {
        if (body.size() < 2) {
            fail("a message of data is " + std::to_string(body.size()) + " bytes: expected 2 or more");
        }
        const auto id = number_at<std::uint16_t>(body.data());
        const std::optional<Subscription>& subscription = subscriptions_[id];
        if (!subscription) {
            fail("there is data of the message " + std::to_string(id) + ", to which nothing has subscribed");
        }
        const std::string_view data = body.substr(2);
        if (data.size() < subscription->bytes) {
            fail("a message of " + excerpt(subscription->message) + " has " + std::to_string(data.size()) +
                 " bytes: its format has " + std::to_string(subscription->bytes));
        }
        for (const Taken& taken : subscription->taken) {
            take_row(*subscription, taken, data.data());
        }
        for (const Watched& watched : subscription->watched) {
            row_.clear();
            for (const Place& place : watched.delta) {
                row_.push_back(number_of(place.type, data.data() + place.at));
            }
            watched.watch->see(time_of(*subscription, data.data()),
                               number_of(watched.counter.type, data.data() + watched.counter.at), row_);
        }
    }

    /// When what a message tells was so [s].
    static double time_of(const Subscription& subscription, const char* data) {
        const auto number = [data](const Place& place) { return number_of(place.type, data + place.at); };
        const double sample_us = subscription.has_sample_time ? number(subscription.sample_time) : 0;
        return 1e-6 * (sample_us > 0 ? sample_us : number(subscription.time));
    }

    void take_row(const Subscription& subscription, const Taken& taken, const char* data) {
        const auto number = [data](const Place& place) { return number_of(place.type, data + place.at); };
        if (!std::ranges::all_of(taken.valid, [&](const Place& flag) { return number(flag) != 0; })) {
            ++taken.into->invalid_rows;
            return;
        }
        row_.clear();
        for (const Place& place : taken.numbers) {
            row_.push_back(number(place));
        }
        LogSeries& series = taken.into->series;
        if (taken.counts_used) {
            if (series.width == 0) {
                const double least_in_use = taken.into->rotor_unit == RotorUnit::microseconds ? 500 : -2;
                series.width = static_cast<std::size_t>(
                    std::ranges::find_if(row_, [&](double each) { return !(each > least_in_use); }) - row_.begin());
            }
            row_.resize(std::min(row_.size(), series.width));
        }
        if (row_.empty() || !std::ranges::all_of(row_, [](double each) { return std::isfinite(each); })) {
            return;
        }
        taken.into->late_rows += series.add(time_of(subscription, data), row_) ? 0 : 1;
    }

    LogBytes& bytes_;
    const LogOptions& options_;
    FlightLog log_;
    std::uint64_t message_at_ = 0;
    ULogFormats formats_;
    std::vector<std::optional<Subscription>> subscriptions_{std::size_t{65536}};
    std::deque<CandidateSeries> candidates_;  // whose elements stay where they are
    std::deque<ResetWatch> watches_;          // as do these
    std::vector<double> row_;
    std::size_t dropouts_ = 0;
};

}  // namespace

FlightLog read_ulog(LogBytes& bytes, const LogOptions& options) {
    return ULog(bytes, options).read();
}

}  // namespace downwash::logs
