#include "downwash/bench/awareness_study/awareness_rows.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "downwash/base/key_error.hpp"

namespace downwash::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The layout of a line. Rows of another one are not read.
constexpr int layout = 1;

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

/// Infinity has no number in JSON.
Json clearance_json(double clearance_m) {
    return std::isfinite(clearance_m) ? Json(clearance_m) : Json("infinite");
}

double clearance_of(const Json& json) {
    return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity();
}

template <class Value>
std::optional<Value> optional_of(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<Value>());
}

/// The value whose name is in a file. @throws std::out_of_range if there is none
template <class Values>
auto value_named(const Values& values, const std::string& name) {
    const auto found =
        std::find_if(std::begin(values), std::end(values), [&](const auto& value) { return name_of(value) == name; });
    if (found == std::end(values)) {
        throw std::out_of_range(name);
    }
    return *found;
}

constexpr std::array all_kinds{PlanKind::first, PlanKind::reported};
constexpr std::array all_statuses{RunStatus::none, RunStatus::approximate, RunStatus::solved, RunStatus::impossible,
                                  RunStatus::error};

Json json_of(const AwarenessRow& row) {
    const Condition& condition = row.condition;
    Json json{{"layout", layout},
              {"kind", name_of(condition.kind)},
              {"level", downwash::name_of(condition.level)},
              {"asked", name_of(condition.asked)},
              {"checks", condition.checks},
              {"robot", name_of(condition.robot)},
              {"time_limit_s", condition.time_limit_s},
              {"problem", row.problem},
              {"seed", row.seed},
              {"hash", row.hash},
              {"commit", row.commit},
              {"status", name_of(row.status)},
              {"error", row.error},
              {"wall_s", row.wall_s},
              {"evaluation_s", row.evaluation_s},
              {"first_candidate_s", or_null(row.first_candidate_s)},
              {"first_certified_s", or_null(row.first_certified_s)}};
    json["certificate"] = row.tested ? Json{{"given", row.tested->is_given},
                                            {"worlds", row.tested->worlds},
                                            {"failures", row.tested->failures},
                                            {"attempts", row.tested->attempts}}
                                     : Json();
    json["discarded"] = row.discarded;
    json["planned_cost"] = or_null(row.planned_cost);
    json["executed"] = row.executed ? Json{{"outcome", downwash::name_of(row.executed->outcome)},
                                           {"cost", row.executed->cost},
                                           {"min_clearance_m", clearance_json(row.executed->min_clearance_m)},
                                           {"duration_s", row.executed->duration_s}}
                                    : Json();
    json["fresh"] = row.fresh ? Json{{"worlds", row.fresh->worlds}, {"failures", row.fresh->failures}} : Json();
    json["nearest_approach_m"] = or_null(row.nearest_approach_m);
    json["missed"] = row.missed;
    return json;
}

/// @throws std::exception when something is missing or no value
AwarenessRow row_of_json(const Json& json) {
    AwarenessRow row;
    row.condition.kind = value_named(all_kinds, json.at("kind"));
    row.condition.level = value_named(all_variants, json.at("level"));
    row.condition.asked = value_named(all_asked, json.at("asked"));
    row.condition.checks = json.at("checks");
    row.condition.robot = value_named(all_robot_choices, json.at("robot"));
    row.condition.time_limit_s = json.at("time_limit_s");
    row.problem = json.at("problem");
    row.seed = json.at("seed");
    row.hash = json.at("hash");
    row.commit = json.at("commit");
    row.status = value_named(all_statuses, json.at("status"));
    row.error = json.at("error");
    row.wall_s = json.at("wall_s");
    row.evaluation_s = json.at("evaluation_s");
    row.first_candidate_s = optional_of<double>(json.at("first_candidate_s"));
    row.first_certified_s = optional_of<double>(json.at("first_certified_s"));
    if (const Json& tested = json.at("certificate"); !tested.is_null()) {
        row.tested =
            CertificateFigures{tested.at("given"), tested.at("worlds"), tested.at("failures"), tested.at("attempts")};
    }
    row.discarded = json.at("discarded");
    row.planned_cost = optional_of<double>(json.at("planned_cost"));
    if (const Json& executed = json.at("executed"); !executed.is_null()) {
        row.executed = ExecutedFlight{value_named(all_outcomes, executed.at("outcome")), executed.at("cost"),
                                      clearance_of(executed.at("min_clearance_m")), executed.at("duration_s")};
    }
    if (const Json& fresh = json.at("fresh"); !fresh.is_null()) {
        row.fresh = FreshFlights{fresh.at("worlds"), fresh.at("failures")};
    }
    row.nearest_approach_m = optional_of<double>(json.at("nearest_approach_m"));
    row.missed = json.at("missed");
    return row;
}

/// A file that is open for appending, for this program alone until it is closed.
class LockedFile {
 public:
    explicit LockedFile(const std::filesystem::path& file)
        : file_(file), descriptor_(::open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666)) {
        if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0) {
            fail();
        }
    }
    ~LockedFile() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    LockedFile(const LockedFile&) = delete;
    LockedFile& operator=(const LockedFile&) = delete;

    /// Whether the last line has its end: a program that was killed may have left half of one.
    [[nodiscard]] bool ends_with_line() const {
        const off_t size = ::lseek(descriptor_, 0, SEEK_END);
        char last = '\n';
        return size == 0 || (::pread(descriptor_, &last, 1, size - 1) == 1 && last == '\n');
    }

    void append(const std::string& text) const {
        std::size_t written = 0;
        while (written < text.size()) {
            const ssize_t count = ::write(descriptor_, text.data() + written, text.size() - written);
            if (count < 0 && errno != EINTR) {
                fail();
            }
            written += count > 0 ? static_cast<std::size_t>(count) : 0;
        }
    }

 private:
    [[noreturn]] void fail() const {
        throw_input_error(file_.string() +
                          " cannot be written: " + std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
    }

    std::filesystem::path file_;
    int descriptor_;
};

}  // namespace

std::string key_of(const Condition& condition, const std::string& problem, std::uint32_t seed) {
    return name_of(condition) + "/" + problem + "/" + std::to_string(seed);
}

std::string line_of(const AwarenessRow& row) {
    return json_of(row).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<AwarenessRow> row_of(const std::string& line) {
    try {
        const Json json = Json::parse(line);
        return json.at("layout") == layout ? std::optional(row_of_json(json)) : std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt;
    } catch (const std::out_of_range&) {
        return std::nullopt;
    }
}

std::vector<AwarenessRow> AwarenessRows::read() const {
    std::vector<AwarenessRow> rows;
    if (!std::filesystem::exists(file_)) {
        return rows;
    }
    std::ifstream in(file_);
    if (!in) {
        throw_input_error(file_.string() + " cannot be read");
    }
    for (std::string line; std::getline(in, line);) {
        if (std::optional<AwarenessRow> row = row_of(line)) {
            rows.push_back(std::move(*row));
        }
    }
    return rows;
}

void AwarenessRows::add(const AwarenessRow& row) {
    const std::string line = line_of(row) + "\n";
    const std::scoped_lock lock(mutex_);
    const LockedFile file(file_);
    file.append(file.ends_with_line() ? line : "\n" + line);
}

}  // namespace downwash::bench
