#pragma once

#include <functional>
#include <map>
#include <stdexcept>
#include <string>

/// The next word of a command line. @throws std::runtime_error if there is none
using NextWord = std::function<std::string()>;
/// What each option does; it takes its values from the words after it.
using CommandOptions = std::map<std::string, std::function<void(const NextWord&)>>;

/// Reads "PROBLEM.yaml [options]". @return the problem
/// @throws std::runtime_error if a word is neither an option nor the one problem
inline std::string read_command_line(int count, char** words, const CommandOptions& options) {
    std::string problem;
    int place = 1;
    const NextWord next = [&] {
        if (place >= count) {
            throw std::runtime_error("a value is missing");
        }
        return std::string(words[place++]);
    };
    while (place < count) {
        const std::string word = next();
        if (const auto option = options.find(word); option != options.end()) {
            option->second(next);
        } else if (problem.empty() && word.rfind("--", 0) != 0) {
            problem = word;
        } else {
            throw std::runtime_error("what is " + word + "?");
        }
    }
    if (problem.empty()) {
        throw std::runtime_error("no problem");
    }
    return problem;
}
