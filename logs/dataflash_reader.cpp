#include "downwash/logs/dataflash_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/logs/candidate_series.hpp"
#include "downwash/logs/dataflash_formats.hpp"
#include "downwash/logs/rotation.hpp"

namespace downwash::logs {
namespace {

/// A message of ArduPilot, and what a series takes from it.
struct Source {
    std::string_view message;
    LogSeries FlightLog::*series;
    std::array<std::string_view, 4> fields;
    std::string_view instance{};  ///< field that has to be 0, if there is one
    bool is_angles = false;       ///< roll, pitch and yaw [deg]
};

/// The best one of each series comes first.
const std::array sources{
    Source{"XKF1", &FlightLog::position_m, {"PN", "PE", "PD"}, "C"},
    Source{"NKF1", &FlightLog::position_m, {"PN", "PE", "PD"}, "C"},
    Source{"XKF1", &FlightLog::velocity_m_s, {"VN", "VE", "VD"}, "C"},
    Source{"NKF1", &FlightLog::velocity_m_s, {"VN", "VE", "VD"}, "C"},
    Source{"ANG", &FlightLog::attitude, {"Roll", "Pitch", "Yaw"}, "", true},
    Source{"ATT", &FlightLog::attitude, {"Roll", "Pitch", "Yaw"}, "", true},
    Source{"XKQ", &FlightLog::attitude, {"Q1", "Q2", "Q3", "Q4"}, "C"},
    Source{"XKF1", &FlightLog::attitude, {"Roll", "Pitch", "Yaw"}, "C", true},
    Source{"IMU", &FlightLog::body_rates_rad_s, {"GyrX", "GyrY", "GyrZ"}, "I"},
    Source{"IMU", &FlightLog::specific_force_m_s2, {"AccX", "AccY", "AccZ"}, "I"},
};

constexpr std::size_t max_motors = 14;  // RCOU has so many channels

/// What of a message goes into a series.
struct Taken {
    CandidateSeries* into;
    std::vector<DataFlashField> fields;
    std::optional<DataFlashField> instance;
    bool is_angles = false;
};

struct Message {
    DataFlashFormat format;
    const DataFlashField* time = nullptr;
    std::vector<Taken> taken;
    bool is_parameter = false, is_outputs = false;
    bool is_event = false, is_error = false;
};

// Numbers of EV and ERR (ArduPilot, libraries/AP_Logger/AP_Logger.h).
constexpr double height_reset_event = 60, heading_reset_event = 62, estimator_error = 24;

class DataFlash {
 public:
    DataFlash(LogBytes& bytes, const LogOptions& options) : bytes_(bytes), options_(options) {
        motor_channels_.fill(0);
    }

    FlightLog read() {
        while (read_message()) {
        }
        log_.files = {bytes_.name()};
        log_.format = LogFormat::dataflash;
        log_.recorded_axes = options_.axes.value_or(LogAxes::down);
        log_.axes_source = options_.axes ? AxesSource::declared : AxesSource::format;
        choose(candidates_, log_);
        choose_motors();
        return std::move(log_);
    }

 private:
    [[noreturn]] void fail(const std::string& message) const { bytes_.fail_at(message_at_, message); }

    bool read_message() {
        message_at_ = bytes_.offset();
        const std::string_view head = bytes_.peek(dataflash_head_bytes);
        if (head.empty()) {
            return false;
        }
        if (head[0] != '\xA3' || (head.size() > 1 && head[1] != '\x95')) {
            fail(message_at_ == 0 ? "is no DataFlash log: expected the bytes a3 95 80"
                                  : "no message begins here: expected the bytes a3 95");
        }
        const unsigned type = head.size() < dataflash_head_bytes ? 0 : static_cast<unsigned char>(head[2]);
        std::size_t size = dataflash_head_bytes;
        const std::unique_ptr<Message>& message = messages_[type];
        if (head.size() == dataflash_head_bytes) {
            if (type == dataflash_format_type) {
                size = dataflash_format_bytes;
            } else if (message) {
                size = message->format.bytes;
            } else {
                fail("a message has the type " + std::to_string(type) + ", which no FMT has defined");
            }
        }
        const std::string_view whole = bytes_.peek(size);
        if (head.size() < dataflash_head_bytes || whole.size() < size) {
            const std::string text = "the log ends within a message";
            if (!options_.allows_truncation) {
                fail(text + "; --allow-truncated reads it up to there");
            }
            log_.remarks.push_back("byte " + std::to_string(message_at_) + ": " + text + ", which is left out");
            return false;
        }
        if (type == dataflash_format_type) {
            define(whole);
        } else {
            take(*message, whole);
        }
        bytes_.skip(size);
        return true;
    }

    void define(std::string_view bytes) {
        DataFlashDefinition definition = read_definition(bytes);
        if (!definition.error.empty()) {
            fail(definition.error);
        }
        if (definition.type == dataflash_format_type) {
            if (definition.format.bytes != dataflash_format_bytes) {
                fail("FMT is said to have " + std::to_string(definition.format.bytes) + " bytes: expected 89");
            }
            return;
        }
        auto message = std::make_unique<Message>();
        message->format = std::move(definition.format);
        const DataFlashFormat& format = message->format;
        message->time = format.find("TimeUS");
        message->is_parameter = format.name == "PARM";
        message->is_outputs = format.name == "RCOU" && message->time != nullptr;
        message->is_event = format.name == "EV" && message->time != nullptr;
        message->is_error = format.name == "ERR" && message->time != nullptr;
        for (std::size_t rank = 0; rank < sources.size() && message->time != nullptr; ++rank) {
            if (sources[rank].message == format.name) {
                take_source(rank, *message);
            }
        }
        if (message->is_outputs) {
            CandidateSeries& outputs = candidate(&FlightLog::rotor_commands, 0);
            outputs.series.source = "RCOU";
            outputs.rotor_unit = RotorUnit::microseconds;
            Taken taken{&outputs, {}, {}, false};
            for (std::size_t channel = 1; channel <= max_motors; ++channel) {
                if (const DataFlashField* field = format.find("C" + std::to_string(channel))) {
                    taken.fields.push_back(*field);
                }
            }
            if (outputs.series.width != 0 && outputs.series.width != taken.fields.size()) {
                fail("RCOU is defined again with another number of channels");
            }
            outputs.series.width = taken.fields.size();
            if (!taken.fields.empty()) {
                message->taken.push_back(std::move(taken));
            }
        }
        messages_[definition.type] = std::move(message);
    }

    CandidateSeries& candidate(LogSeries FlightLog::*what, std::size_t rank) {
        const auto known = std::ranges::find_if(
            candidates_, [&](const CandidateSeries& each) { return each.what == what && each.rank == rank; });
        if (known != candidates_.end()) {
            return *known;
        }
        candidates_.emplace_back();
        candidates_.back().what = what;
        candidates_.back().rank = rank;
        return candidates_.back();
    }

    void take_source(std::size_t rank, Message& message) {
        const Source& source = sources[rank];
        Taken taken{nullptr, {}, {}, source.is_angles};
        for (const std::string_view name : source.fields) {
            const DataFlashField* field = name.empty() ? nullptr : message.format.find(name);
            if (!name.empty() && (field == nullptr || !field->is_number)) {
                return;
            }
            if (field != nullptr) {
                taken.fields.push_back(*field);
            }
        }
        if (const DataFlashField* instance = message.format.find(source.instance)) {
            taken.instance = *instance;
        }
        CandidateSeries& into = candidate(source.series, rank);
        into.series.source = source.message;
        into.series.width = source.series == &FlightLog::attitude ? 4 : 3;
        taken.into = &into;
        message.taken.push_back(std::move(taken));
    }

    static double number_in(const DataFlashField& field, std::string_view bytes) {
        return field.scale * number_of(field.type, bytes.data() + field.at);
    }

    void take(const Message& message, std::string_view bytes) {
        if (message.is_parameter) {
            take_parameter(message.format, bytes);
        }
        if (message.is_event || message.is_error) {
            take_jump(message, bytes);
        }
        for (const Taken& taken : message.taken) {
            if (taken.instance && number_in(*taken.instance, bytes) != 0) {
                continue;
            }
            row_.clear();
            for (const DataFlashField& field : taken.fields) {
                row_.push_back(number_in(field, bytes));
            }
            if (taken.is_angles) {
                const std::array<double, 4> q = quaternion_of_angles(
                    row_[0] / degrees_per_radian, row_[1] / degrees_per_radian, row_[2] / degrees_per_radian);
                row_.assign(q.begin(), q.end());
            }
            taken.into->late_rows += taken.into->series.add(1e-6 * number_in(*message.time, bytes), row_) ? 0 : 1;
        }
    }

    /// What says that the estimator was reset, or that the autopilot flies by another one from here on.
    void take_jump(const Message& message, std::string_view bytes) {
        const auto number = [&](std::string_view name) {
            const DataFlashField* field = message.format.find(name);
            return field != nullptr && field->is_number ? number_in(*field, bytes) : -1;
        };
        LogJump jump;
        jump.t_s = 1e-6 * number_in(*message.time, bytes);
        const double what = number(message.is_event ? "Id" : "Subsys");
        if (message.is_event && (what == height_reset_event || what == heading_reset_event)) {
            jump.kind = what == height_reset_event ? JumpKind::height : JumpKind::heading;
            jump.source = "EV " + to_text(what);
        } else if (message.is_error && what == estimator_error) {
            jump.kind = JumpKind::estimator;
            jump.source = "ERR 24: it flies by core " + to_text(number("ECode"));
            log_.remarks.push_back("the autopilot flies by core " + to_text(number("ECode")) +
                                   " of its estimator from " + to_fixed_text(jump.t_s, 1) +
                                   " s of its clock on; places here are those of core 0");
        } else {
            return;
        }
        log_.jumps.push_back(std::move(jump));
    }

    /// SERVO3_FUNCTION = 33: channel 3 drives motor 1.
    void take_parameter(const DataFlashFormat& format, std::string_view bytes) {
        constexpr std::size_t name_bytes = 16;
        const DataFlashField* name = format.find("Name");
        const DataFlashField* value = format.find("Value");
        if (name == nullptr || value == nullptr || name->is_number || !value->is_number ||
            name->at + name_bytes > bytes.size()) {
            return;
        }
        std::string_view text = bytes.substr(name->at, name_bytes);
        text = text.substr(0, text.find('\0'));
        if (!text.starts_with("SERVO") || !text.ends_with("_FUNCTION")) {
            return;
        }
        const auto channel = parse_number<unsigned>(text.substr(5, text.size() - 14));
        const double function = number_in(*value, bytes);
        constexpr double first_motor = 33, last_motor = 40;
        if (channel && *channel >= 1 && *channel <= max_motors && function >= first_motor && function <= last_motor) {
            motor_channels_[static_cast<std::size_t>(function - first_motor)] = *channel;
        }
    }

    /// Leaves the channels of motors in their order; those that parameters name, or the first ones with pulses.
    void choose_motors() {
        LogSeries& commands = log_.rotor_commands;
        if (commands.empty()) {
            return;
        }
        std::vector<std::size_t> channels;
        for (const unsigned channel : motor_channels_) {
            if (channel == 0 || channel > commands.width) {
                break;
            }
            channels.push_back(channel - 1);
        }
        if (channels.empty()) {
            constexpr double least_pulse_us = 500;
            while (channels.size() < commands.width && commands.row(0)[channels.size()] > least_pulse_us) {
                channels.push_back(channels.size());
            }
            log_.remarks.push_back("no parameter says which outputs drive motors: the first " +
                                   std::to_string(channels.size()) + " are taken for them");
        }
        LogSeries motors;
        motors.source = commands.source;
        motors.width = channels.size();
        for (std::size_t i = 0; i < commands.rows() && !channels.empty(); ++i) {
            row_.clear();
            for (const std::size_t channel : channels) {
                row_.push_back(commands.row(i)[channel]);
            }
            motors.add(commands.t_s[i], row_);
        }
        commands = std::move(motors);
    }

    LogBytes& bytes_;
    const LogOptions& options_;
    FlightLog log_;
    std::uint64_t message_at_ = 0;
    std::array<std::unique_ptr<Message>, 256> messages_;
    std::deque<CandidateSeries> candidates_;  // whose elements stay where they are
    std::array<unsigned, 8> motor_channels_{};
    std::vector<double> row_;
};

}  // namespace

FlightLog read_dataflash(LogBytes& bytes, const LogOptions& options) {
    return DataFlash(bytes, options).read();
}

}  // namespace downwash::logs
