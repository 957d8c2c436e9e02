#include "downwash/thrust_stand/stand_columns.hpp"

#include <algorithm>
#include <cctype>
#include <numbers>
#include <utility>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"

namespace downwash::thrust_stand {
namespace {

constexpr double gram_force_n = 0.00980665, pound_force_n = 4.4482216152605;
constexpr double inch_m = 0.0254, foot_m = 0.3048;
constexpr double turn_rad = 2 * std::numbers::pi;

/// A unit by all its spellings, as plain() makes them. The first is what messages call it.
struct Unit {
    std::array<std::string_view, 5> names;
    double factor;
};

/// The names and units of one quantity. Names that stand first are preferred.
struct Known {
    Quantity quantity;
    std::string_view name;
    std::vector<std::string_view> words;
    std::vector<Unit> units;
    std::string_view implied;  ///< the unit without one in the file; empty: it has to say
};

const std::vector<Unit>& power_units() {
    static const std::vector<Unit> units{{{"W", "watt", "watts"}, 1}, {{"kW"}, 1000}, {{"mW"}, 1e-3}};
    return units;
}

const std::vector<Known>& known() {
    static const std::vector<Known> all{
        {Quantity::time,
         "time",
         {"time", "timestamp"},
         {{{"s", "sec", "seconds"}, 1}, {{"ms"}, 1e-3}, {{"us"}, 1e-6}, {{"min"}, 60}},
         "s"},
        {Quantity::throttle,
         "throttle",
         {"esc signal", "esc throttle", "throttle", "esc", "pwm", "command"},
         {{{"us"}, 1}, {{"ms"}, 1}, {{"%", "percent"}, 1}, {{"1"}, 1}},
         "1"},
        {Quantity::thrust,
         "thrust",
         {"thrust", "pull", "lift"},
         {{{"N", "newton", "newtons"}, 1},
          {{"gf", "g", "gram", "grams"}, gram_force_n},
          {{"kgf", "kg", "kp"}, 1e3 * gram_force_n},
          {{"lbf", "lb", "lbs"}, pound_force_n},
          {{"ozf", "oz"}, pound_force_n / 16}},
         ""},
        {Quantity::torque,
         "torque",
         {"torque"},
         {{{"Nm"}, 1},
          {{"mNm"}, 1e-3},
          {{"Ncm"}, 1e-2},
          {{"kgfm", "kgm"}, 1e3 * gram_force_n},
          {{"kgfcm", "kgcm"}, 10 * gram_force_n},
          {{"gfcm", "gcm"}, 1e-2 * gram_force_n},
          {{"lbfin", "lbin", "inlb", "inlbf"}, pound_force_n * inch_m},
          {{"lbfft", "lbft", "ftlb", "ftlbf"}, pound_force_n * foot_m},
          {{"ozfin", "ozin", "inoz"}, pound_force_n * inch_m / 16}},
         ""},
        {Quantity::speed,
         "speed",
         {"motor optical speed", "optical speed", "motor electrical speed", "electrical speed", "motor speed",
          "rotation speed", "rotational speed", "rotor speed", "speed", "omega", "rpm"},
         {{{"RPM", "r/min", "rev/min", "1/min", "min1"}, turn_rad / 60},
          {{"rad/s", "rads"}, 1},
          {{"Hz", "1/s", "rev/s", "rps", "r/s"}, turn_rad}},
         ""},
        {Quantity::voltage,
         "voltage",
         {"voltage", "volts", "volt"},
         {{{"V", "volt", "volts"}, 1}, {{"mV"}, 1e-3}},
         "V"},
        {Quantity::current,
         "current",
         {"current", "amps", "amp", "amperage"},
         {{{"A", "amp", "amps"}, 1}, {{"mA"}, 1e-3}},
         "A"},
        {Quantity::power,
         "power",
         {"electrical power", "electric power", "input power", "power", "watts", "watt"},
         power_units(),
         "W"},
        {Quantity::shaft_power, "shaft_power", {"mechanical power", "shaft power", "output power"}, power_units(), "W"},
        {Quantity::ct, "ct", {"ct"}, {{{"1"}, 1}}, "1"},
        {Quantity::cp, "cp", {"cp"}, {{{"1"}, 1}}, "1"},
    };
    return all;
}

const Known& known_of(Quantity quantity) {
    return known()[static_cast<std::size_t>(quantity)];
}

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

/// A unit without what writers differ in: "nm" of "N\u00b7m", "us" of "\u00b5s". Dots, blanks and dashes go.
std::string plain(std::string_view text) {
    std::string unit;
    for (std::size_t i = 0; i < text.size();) {
        const std::string_view letter = text.substr(i, std::max<std::size_t>(utf8_length(text.substr(i)), 1));
        if (letter == "\u00b5" || letter == "\u03bc") {
            unit += 'u';
        } else if (letter.size() == 1 &&
                   (std::isalnum(static_cast<unsigned char>(letter[0])) != 0 || letter == "/" || letter == "%")) {
            unit += letter;
        }
        i += letter.size();
    }
    return in_lower_case(unit);
}

const Unit* unit_named(const Known& quantity, std::string_view written) {
    const std::string wanted = plain(written);
    const auto found = std::ranges::find_if(quantity.units, [&wanted](const Unit& unit) {
        return std::ranges::any_of(
            unit.names, [&](std::string_view name) { return !name.empty() && in_lower_case(name) == wanted; });
    });
    return found == quantity.units.end() ? nullptr : &*found;
}

/// A column's name as words, and the unit in brackets behind them.
struct WrittenName {
    std::string words;
    std::optional<std::string> unit;
};

WrittenName written_name(std::string_view name) {
    WrittenName written;
    std::string_view words = trimmed(name);
    if (!words.empty() && (words.back() == ')' || words.back() == ']')) {
        const std::size_t open = words.rfind(words.back() == ')' ? '(' : '[');
        if (open != std::string_view::npos && open > 0) {
            written.unit = std::string(words.substr(open + 1, words.size() - open - 2));
            words = trimmed(words.substr(0, open));
        }
    }
    written.words = in_lower_case(words);
    std::ranges::replace(written.words, '_', ' ');
    return written;
}

/// What stands behind a word of a name, empty if the name is that word. Nothing if the name begins otherwise.
std::optional<std::string> behind(const std::string& name, std::string_view word) {
    if (!name.starts_with(word)) {
        return std::nullopt;
    }
    const std::string rest = name.substr(word.size());
    if (rest.empty()) {
        return rest;
    }
    const std::size_t first = rest.find_first_not_of(" -:,/");
    return first == 0 || first == std::string::npos ? std::nullopt : std::optional(rest.substr(first));
}

class Finder {
 public:
    Finder(const CsvReader& csv, const ThrustStandSettings& settings, LineErrors& errors)
        : csv_(csv), settings_(settings), errors_(errors) {}

    std::vector<FoundColumn> found() {
        require_quantities(settings_.columns);
        require_quantities(settings_.units);
        for (const Known& quantity : known()) {
            if (const auto* chosen = given(settings_.columns, quantity.name)) {
                take_chosen(quantity, *chosen);
                continue;
            }
            for (std::size_t rank = 0; rank < quantity.words.size(); ++rank) {
                take_named(quantity, quantity.words[rank]);
            }
        }
        require_thrust();
        errors_.throw_any();
        return std::move(columns_);
    }

 private:
    using Given = std::vector<std::pair<std::string, std::string>>;

    static const std::string* given(const Given& list, std::string_view quantity) {
        const auto found = std::ranges::find_if(list, [quantity](const auto& each) { return each.first == quantity; });
        return found == list.end() ? nullptr : &found->second;
    }

    void require_quantities(const Given& list) {
        std::vector<std::string_view> names;
        for (const Known& quantity : known()) {
            names.push_back(quantity.name);
        }
        for (const auto& [quantity, value] : list) {
            if (std::ranges::find(names, quantity) == names.end()) {
                errors_.add(0, "'" + excerpt(quantity) + "' is no quantity: expected " + joined_names(names) +
                                   did_you_mean(quantity, names));
            }
        }
    }

    void take_chosen(const Known& quantity, const std::string& name) {
        const auto column = csv_.find(name);
        if (!column) {
            errors_.add(csv_.header_line(),
                        "has no column '" + excerpt(name) + "' in '" + excerpt(joined(csv_.names(), ", ")) + "'");
            return;
        }
        const WrittenName written = written_name(name);
        // The unit may be the last word: "Schub kgf".
        const std::size_t last = written.words.rfind(' ');
        const std::string word = last == std::string::npos ? "" : written.words.substr(last + 1);
        take(quantity, *column,
             written.unit                 ? written.unit
             : unit_named(quantity, word) ? std::optional(word)
                                          : std::nullopt);
    }

    void take_named(const Known& quantity, std::string_view word) {
        for (std::size_t i = 0; i < csv_.names().size(); ++i) {
            const WrittenName written = written_name(csv_.names()[i]);
            const auto rest = behind(written.words, word);
            const bool is_meant = rest && (rest->empty() || (!written.unit && unit_named(quantity, *rest) != nullptr));
            const bool is_taken =
                std::ranges::any_of(columns_, [i](const FoundColumn& column) { return column.index == i; });
            if (is_meant && !is_taken) {
                take(quantity, i, rest->empty() ? written.unit : rest, word);
            }
        }
    }

    void take(const Known& quantity, std::size_t index, std::optional<std::string> unit, std::string_view word = "") {
        if (const auto* said = given(settings_.units, quantity.name)) {
            unit = *said;
        }
        // "RPM" and "Watts" are units themselves.
        const std::string_view own = unit_named(quantity, word) != nullptr ? word : quantity.implied;
        const Unit* known_unit = unit_named(quantity, unit.value_or(std::string(own)));
        if (known_unit != nullptr) {
            columns_.push_back({quantity.quantity, index, std::string(known_unit->names[0]), known_unit->factor});
            return;
        }
        std::vector<std::string_view> names;
        for (const Unit& each : quantity.units) {
            names.push_back(each.names[0]);
        }
        const std::string name(quantity.name);
        errors_.add(csv_.header_line(), csv_.header_place(index),
                    "the column '" + excerpt(csv_.names()[index]) + "' " +
                        (unit ? "is in '" + excerpt(*unit) + "'" : std::string("has no unit")) + ": expected " +
                        joined_names(names) + "; say it by --unit " + name + "=UNIT");
    }

    void require_thrust() {
        const auto has = [this](Quantity wanted) {
            return std::ranges::any_of(columns_, [wanted](const FoundColumn& c) { return c.quantity == wanted; });
        };
        if (has(Quantity::thrust)) {
            return;
        }
        if (!has(Quantity::ct)) {
            errors_.add(csv_.header_line(), "has no thrust in '" + excerpt(joined(csv_.names(), ", ")) +
                                                "': expected a column such as 'Thrust (gf)' or CT; name it by --column "
                                                "thrust=NAME");
            return;
        }
        if (!has(Quantity::speed)) {
            errors_.add(csv_.header_line(), "has CT without a speed: expected a column such as RPM");
        }
        if (const auto advance = csv_.find("J")) {
            errors_.add(csv_.header_line(), csv_.header_place(*advance),
                        "the advance ratio J says that this was measured in forward flight: expected static thrust");
        }
        if (!settings_.radius_m) {
            errors_.add(csv_.header_line(),
                        "has coefficients instead of a thrust: give --radius-m M, the rotor's radius");
        }
    }

    const CsvReader& csv_;
    const ThrustStandSettings& settings_;
    LineErrors& errors_;
    std::vector<FoundColumn> columns_;
};

}  // namespace

std::string_view name_of(Quantity quantity) {
    return known_of(quantity).name;
}

std::vector<FoundColumn> find_columns(const CsvReader& csv, const ThrustStandSettings& settings, LineErrors& errors) {
    return Finder(csv, settings, errors).found();
}

}  // namespace downwash::thrust_stand
