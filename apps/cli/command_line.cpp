#include "downwash/cli/command_line.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"

namespace downwash::cli {
namespace {

/// "N" of an option that takes a number, without the check that follows.
std::string placeholder_of(const CLI::Option& option) {
    const std::string name = option.get_type_name();
    return name.substr(0, name.find(':'));
}

/// The command that was given, at any depth.
CLI::App& given_command(CLI::App& program) {
    CLI::App* command = &program;
    for (auto given = command->get_subcommands(); !given.empty(); given = command->get_subcommands()) {
        command = given.front();
    }
    return *command;
}

/// What is wrong in a command line, with a remedy. CLI11 says which option and which value, but not what it expects.
std::string explained(CLI::App& command, const CLI::Error& error) {
    const std::string message = error.what();
    std::string_view name = message;
    if (error.get_name() == "ConversionError" && name.starts_with("Could not convert: ")) {
        name.remove_prefix(std::string_view("Could not convert: ").size());
    }
    for (const CLI::Option* option : command.get_options()) {
        const std::string spelled = option->get_name();
        if (!name.starts_with(spelled) ||
            (name.size() > spelled.size() && name[spelled.size()] != ' ' && name[spelled.size()] != ':')) {
            continue;
        }
        const std::string expected = fmt::format(
            "{}: {}", option->get_positional() ? option->get_name(true) : spelled + " " + placeholder_of(*option),
            option->get_description());
        const std::string_view value = name.substr(spelled.size());
        if (error.get_name() == "ConversionError" && value.starts_with(" = ")) {
            return fmt::format("{} is '{}': expected {}", spelled, excerpt(value.substr(3)), expected);
        }
        if (error.get_name() == "RequiredError") {
            return fmt::format("{} is required: expected {}", spelled, expected);
        }
        if (error.get_name() == "ArgumentMismatch" && option->get_items_expected_min() > 1) {
            return fmt::format("{} takes {} values: expected {}", spelled, option->get_items_expected_min(), expected);
        }
        constexpr std::string_view colon = ": ", none_of = " not in {";
        if (const std::size_t list = value.rfind(none_of);
            value.starts_with(colon) && list != std::string_view::npos && value.ends_with("}")) {
            std::vector<std::string_view> names;
            const std::string_view words = value.substr(list + none_of.size());
            for (std::size_t begin = 0; begin < words.size();) {
                const std::size_t end = words.find_first_of(",}", begin);
                names.push_back(words.substr(begin, end - begin));
                begin = end + 1;
            }
            const std::string_view given = value.substr(colon.size(), list - colon.size());
            return fmt::format("{} is '{}': expected {}{}", spelled, excerpt(given), joined_names(names),
                               did_you_mean(given, names));
        }
        constexpr std::string_view before = ": Value ", after = " not in range ";
        if (const std::size_t range = value.rfind(after);
            value.starts_with(before) && range != std::string_view::npos) {
            return fmt::format("{} is '{}': expected {}; {}", spelled,
                               excerpt(value.substr(before.size(), range - before.size())),
                               value.substr(range + after.size()), expected);
        }
        if (error.get_name() == "ValidationError" || error.get_name() == "ArgumentMismatch") {
            return fmt::format("{}; expected {}", message, expected);
        }
    }
    return error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)
               ? fmt::format("{}: expected {}", message, Command(&command).usage())
               : message;
}

/// The error in a command line, and the command that prints help.
std::string usage_error(CLI::App& program, const CLI::Error& error) {
    CLI::App& command = given_command(program);
    return fmt::format("{}: {}\nSee {} --help.\n", program.get_name(), explained(command, error),
                       Command(&command).full_name());
}

}  // namespace

Option Option::required() {
    option_->required();
    return *this;
}

Option Option::excludes(Option other) {
    option_->excludes(other.option_);
    return *this;
}

Option Option::values(int min, int max) {
    option_->expected(min, max);
    return *this;
}

Option Option::repeated() {
    option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}

Option Option::shows_default() {
    option_->capture_default_str();
    return *this;
}

template <class Number>
Option Option::in_range(Number min, Number max) {
    option_->check(CLI::Range(min, max));
    return *this;
}

template Option Option::in_range(int, int);
template Option Option::in_range(double, double);
template Option Option::in_range(std::uint64_t, std::uint64_t);

Option Option::positive() {
    option_->check(CLI::PositiveNumber);
    return *this;
}

Option Option::in_bytes() {
    option_->transform(CLI::AsSizeValue(false));
    return *this;
}

Option Option::placeholder(const std::string& text) {
    option_->type_name(text);
    return *this;
}

// CLI11 does not store words to offer: they are the name of an option's only check.
Option Option::offer(const std::vector<std::string_view>& words) {
    option_->check(CLI::Validator([](std::string& /*text*/) { return std::string(); }, "", joined(words, " ")));
    return *this;
}

Option Option::offers_files(const std::vector<std::string>& endings) {
    return offer(std::vector<std::string_view>{fmt::format("@{}", fmt::join(endings, " @"))});
}

Option Option::one_of(const std::vector<std::string>& words) {
    option_->type_name(fmt::format("{}", fmt::join(words, "|")));
    option_->check(CLI::IsMember(words), joined(words, " "));
    return *this;
}

std::string Option::offered_words() const {
    try {
        return option_->get_validator()->get_name();
    } catch (const CLI::OptionNotFound&) {
        return {};  // it has no check
    }
}

bool Option::is_given() const {
    return option_->count() > 0;
}

bool Option::is_positional() const {
    return option_->get_positional();
}

bool Option::is_required() const {
    return option_->get_required();
}

std::string Option::spelling() const {
    return is_positional() ? option_->get_name(true) : option_->get_name(false, true);
}

std::string Option::name() const {
    return is_positional() ? option_->get_name(true) : option_->get_name();
}

std::vector<std::string> Option::names() const {
    std::vector<std::string> all;
    for (const std::string& name : option_->get_lnames()) {
        all.push_back("--" + name);
    }
    for (const std::string& name : option_->get_snames()) {
        all.push_back("-" + name);
    }
    return all;
}

std::string Option::type() const {
    return option_->get_type_name();
}

std::string Option::description() const {
    return option_->get_description();
}

std::string Option::default_text() const {
    return option_->get_default_str();
}

int Option::max_values() const {
    return option_->get_items_expected_max();
}

Command Command::add_command(const std::string& name, const std::string& description) {
    return Command(app_->add_subcommand(name, description));
}

void Command::require_command() {
    app_->require_subcommand(1);
}

void Command::on_given(std::function<void()> act) {
    app_->callback(std::move(act));
}

template <class Value>
Option Command::add_option(const std::string& spelling, Value& value, const std::string& description) {
    const std::size_t blank = spelling.find(' ');
    CLI::Option* added = app_->add_option(spelling.substr(0, blank), value, description);
    if constexpr (std::is_same_v<Value, std::uint64_t> || std::is_same_v<Value, std::optional<std::uint64_t>>) {
        // CLI11 reads -3 as 2^64 - 3.
        added->check([](const std::string& text) {
            return text.starts_with('-') ? "is " + text + ": expected a whole number from 0" : std::string();
        });
    }
    return Option(blank == std::string::npos ? added : added->type_name(spelling.substr(blank + 1)));
}

template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::array<double, 2>>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::array<double, 3>>&, const std::string&);

Option Command::add_text(const std::string& spelling, const std::function<void(const std::string&)>& take,
                         const std::string& description) {
    const std::size_t blank = spelling.find(' ');
    return Option(app_->add_option_function<std::string>(spelling.substr(0, blank), take, description)
                      ->type_name(spelling.substr(blank + 1)));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& description) {
    return Option(app_->add_flag(name, value, description));
}

const std::string& Command::name() const {
    return app_->get_name();
}

std::string Command::full_name() const {
    return is_program() ? name() : Command(app_->get_parent()).full_name() + " " + name();
}

std::string Command::usage() const {
    if (!commands().empty()) {
        return full_name() + " COMMAND";
    }
    std::string line = full_name() + " [OPTIONS]";
    for (const Option& option : options()) {
        if (option.is_positional()) {
            const std::string word = option.name() + (option.max_values() > 1 ? "..." : "");
            line += option.is_required() ? " " + word : " [" + word + "]";
        }
    }
    return line;
}

std::string Command::description() const {
    return app_->get_description();
}

std::string Command::footer() const {
    return app_->get_footer();
}

bool Command::is_program() const {
    return app_->get_parent() == nullptr;
}

std::vector<Command> Command::commands() const {
    std::vector<Command> below;
    for (CLI::App* app : app_->get_subcommands([](CLI::App* one) { return !one->get_name().empty(); })) {
        below.emplace_back(app);
    }
    return below;
}

std::vector<Option> Command::options() const {
    std::vector<Option> all;
    for (const bool is_positional : {true, false}) {
        const auto is_of_kind = [=](CLI::Option* option) { return option->get_positional() == is_positional; };
        for (CLI::Option* option : app_->get_options(is_of_kind)) {
            all.emplace_back(option);
        }
    }
    return all;
}

Option Command::option(const std::string& name) const {
    return Option(app_->get_option(name));
}

CommandLine::CommandLine(const std::string& description, const std::string& version, const std::string& footer)
    : app_(std::make_unique<CLI::App>(description, "downwash")) {
    app_->set_version_flag("--version", version);
    app_->require_subcommand(1);
    app_->footer(footer);
    app_->failure_message(
        [app = app_.get()](const CLI::App* /*program*/, const CLI::Error& error) { return usage_error(*app, error); });
}

CommandLine::~CommandLine() = default;

std::optional<ExitCode> CommandLine::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
        return std::nullopt;
    } catch (const CLI::ParseError& end) {  // help and version too
        return app_->exit(end) == 0 ? ExitCode::done : ExitCode::bad_input;
    }
}

}  // namespace downwash::cli
