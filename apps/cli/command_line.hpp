#pragma once

// Commands and their options. CLI11 reads the command line; its headers take longer to compile than most commands, so
// only command_line.cpp includes them.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/cli/exit_code.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace downwash::cli {

/// What a parsed command line asks for.
using Action = std::function<ExitCode()>;

/// A positional argument, an option with values, or a flag. A handle: a copy stands for the same option.
class Option {
 public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required();
    /// Rejects a command line with both options.
    Option excludes(Option other);
    /// Takes so many values.
    Option values(int count) { return values(count, count); }
    Option values(int min, int max);
    /// Keeps the values of every occurrence, each with its own values.
    Option repeated();
    /// Shows the current value as the default in the help.
    Option shows_default();
    /// Rejects numbers outside of these limits.
    template <class Number>
    Option in_range(Number min, Number max);
    /// Rejects numbers that are not above 0.
    Option positive();
    /// Takes sizes in bytes such as 500MiB and 4GiB.
    Option in_bytes();
    /// Sets what stands for the value in the help: "N".
    Option placeholder(const std::string& text);
    /// Makes shells offer words. The value is not checked.
    template <class Words>
    Option offers(const Words& words) {
        return offer({std::begin(words), std::end(words)});
    }
    /// Makes shells offer folders and files with these endings (".yaml").
    Option offers_files(const std::vector<std::string>& endings);
    /// Restricts the value to these words. They are offered and shown as its type.
    Option one_of(const std::vector<std::string>& words);

    [[nodiscard]] bool is_given() const;
    [[nodiscard]] bool is_positional() const;
    [[nodiscard]] bool is_required() const;
    /// "PROBLEM" or "-o,--out"
    [[nodiscard]] std::string spelling() const;
    /// "--out"; the argument's name if it is positional
    [[nodiscard]] std::string name() const;
    /// "--out", then "-o"; empty if it is positional
    [[nodiscard]] std::vector<std::string> names() const;
    /// What stands for its value in the help, with a check that follows a colon: "INT:INT in [1 - 256]".
    [[nodiscard]] std::string type() const;
    [[nodiscard]] std::string description() const;
    /// Empty if none is shown.
    [[nodiscard]] std::string default_text() const;
    [[nodiscard]] int max_values() const;
    /// The words that shells offer after it, with blanks between them; "@.yaml" stands for folders and such files.
    [[nodiscard]] std::string offered_words() const;

 private:
    Option offer(const std::vector<std::string_view>& words);

    CLI::Option* option_;
};

/// The program or one of its commands, at any depth. A handle: a copy stands for the same command.
class Command {
 public:
    explicit Command(CLI::App* app = nullptr) : app_(app) {}

    Command add_command(const std::string& name, const std::string& description);
    /// Requires one of the commands below.
    void require_command();
    /// Sets what is called when the command is given.
    void on_given(std::function<void()> act);

    /// Adds an option with a value, spelled as in the help ("--step M" or "-o,--out FILE"), or a positional argument
    /// ("PROBLEM"). command_line.cpp lists the types that a value may have.
    template <class Value>
    Option add_option(const std::string& spelling, Value& value, const std::string& description);
    /// Adds such an option whose text a function takes.
    Option add_text(const std::string& spelling, const std::function<void(const std::string&)>& take,
                    const std::string& description);
    Option add_flag(const std::string& name, bool& value, const std::string& description);

    /// "solve"
    [[nodiscard]] const std::string& name() const;
    /// "downwash aeromap plot"
    [[nodiscard]] std::string full_name() const;
    /// "downwash solve [OPTIONS] PROBLEM"
    [[nodiscard]] std::string usage() const;
    [[nodiscard]] std::string description() const;
    /// The text below the help.
    [[nodiscard]] std::string footer() const;
    [[nodiscard]] bool is_program() const;
    /// The commands directly below, in their order.
    [[nodiscard]] std::vector<Command> commands() const;
    /// Positional arguments, then options, each in their order, `--help` among them.
    [[nodiscard]] std::vector<Option> options() const;
    /// The option of a name: "--json". @pre there is one
    [[nodiscard]] Option option(const std::string& name) const;

 private:
    CLI::App* app_;
};

/// Calls visit(command) for a command and all below it.
template <class Visit>
void for_each_command(const Command& command, const Visit& visit) {
    visit(command);
    for (const Command& below : command.commands()) {
        for_each_command(below, visit);
    }
}

/// The program's whole command line.
class CommandLine {
 public:
    /// @param version what --version prints   @param footer the text below the help
    CommandLine(const std::string& description, const std::string& version, const std::string& footer);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// The program, for commands to be added.
    [[nodiscard]] Command program() { return Command(app_.get()); }

    /// Reads the words that the program was called with, and calls what the given command has set with on_given().
    /// Prints help, version and errors. @return the exit code if that was all
    [[nodiscard]] std::optional<ExitCode> parse(int argc, char** argv);

 private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace downwash::cli
